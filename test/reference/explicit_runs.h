#pragma once
/// What the tests of explicit schemes share: their methods, and runs to a time.

#include <string>

#include "reference/dynamics_runs.h"

namespace flexarm::test {

struct ExplicitMethod {
  const char* name;
  int order;
  int steps;  ///< in a second, with errors far above round-off for twice as many
};

class ExplicitRuns : public ::testing::TestWithParam<ExplicitMethod> {
 protected:
  Simulation after(const SceneBuilder& b, double end, int steps) const {
    Simulation s(b.scene, options(GetParam().name, end / steps, 1e-12));
    run(s, steps);
    return s;
  }
  /// A simulation whose steps depend on the state alone, in steps of 10 ms.
  Simulation without_memory(const SceneBuilder& b) const {
    return Simulation(b.scene, full_newton(options(GetParam().name, 0.01, 1e-12)));
  }
};

inline const auto kExplicitMethods = ::testing::Values(ExplicitMethod{"rk4", 4, 80}, ExplicitMethod{"dop853", 8, 16});

inline std::string method_name(const ::testing::TestParamInfo<ExplicitMethod>& info) {
  return info.param.name;
}

}  // namespace flexarm::test
