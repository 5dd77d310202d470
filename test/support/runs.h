#pragma once
/// Runs of simulations, and what must stay constant in them.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"
#include "simulation/inside.h"

namespace flexarm::test {

/// Options of a run; those of the scene where none are given. Step in s.
inline SimulationOptions options(const std::string& scheme, std::optional<double> step = {},
                                 std::optional<double> tolerance = {}) {
  SimulationOptions out;
  out.scheme = scheme;
  out.step = step;
  out.tolerance = tolerance;
  return out;
}

/// New factors in every iteration: it converges to round-off, and steps depend on the state alone.
inline SimulationOptions full_newton(SimulationOptions options = {}) {
  options.reuse_factorisation = false;
  return options;
}

/// Makes a step, and explains it if it does not converge.
inline ::testing::AssertionResult steps(Simulation& simulation) {
  const StepResult result = simulation.step();
  if (result.converged) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << simulation.scheme() << " at t = " << simulation.time() << ": "
                                       << simulation.explain(result);
}

/// Makes `count` steps, with `observe()` after each. A step that does not converge ends the run.
template <class Observe>
void run(Simulation& simulation, int count, const Observe& observe) {
  for (int n = 0; n < count && !::testing::Test::HasFatalFailure(); ++n) {
    ASSERT_TRUE(steps(simulation));
    observe();
  }
}
inline void run(Simulation& simulation, int count) {
  run(simulation, count, [] {});
}

/// Makes steps until the one that ends nearest to `end` [s], with `observe()` after each.
template <class Observe>
void run_until(Simulation& simulation, double end, const Observe& observe) {
  while (simulation.time() < end - 0.5 * simulation.step_size() && !::testing::Test::HasFatalFailure()) {
    ASSERT_TRUE(steps(simulation));
    observe();
  }
}
inline void run_until(Simulation& simulation, double end) {
  run_until(simulation, end, [] {});
}

/// Order of convergence between two meshes or steps, the second of which is twice as fine.
inline double observed_order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

/// The value of a result column, such as "tendon/rope/tension".
inline double column(const Simulation& simulation, const std::string& name) {
  return ResultColumns(simulation, ResultColumns::Solver::Without, {name}).row(simulation, {}).back();
}

inline double position_of(const Simulation& simulation, const std::string& coordinate) {
  return simulation.position(simulation.find_coordinate(coordinate).value());
}

/// The index of a link; that behind the last one if there is none.
inline std::size_t link_of(const Simulation& simulation, const std::string& link) {
  const std::vector<std::string>& names = simulation.link_names();
  return std::find(names.begin(), names.end(), link) - names.begin();
}

/// The constant of the account of energies: what is stored, less the work from outside, and what was dissipated [J].
inline double energy_account(const Simulation& simulation) {
  const Energies now = simulation.energies();
  return now.total() - now.work + now.dissipated;
}

inline double total_mass(const Simulation& simulation) {
  double mass = 0;
  for (const NodalInertia& inertia : model_of(simulation).inertias) mass += inertia.total_mass;
  return mass;
}

/// Largest change of energy and momenta since construction, relative to their largest values. The linear momentum is
/// relative to sqrt(2 m T), because the total may vanish although its parts do not.
class InvariantDrift {
 public:
  explicit InvariantDrift(const Simulation& simulation)
      : simulation_(simulation),
        balance_(energy_account(simulation)),
        linear_(simulation.momentum()),
        angular_(simulation.angular_momentum()) {
    observe();
  }
  void observe() {
    const Energies e = simulation_.energies();
    energy_scale_ = std::max({energy_scale_, e.kinetic, e.strain, std::abs(e.potential), e.dissipated});
    linear_scale_ = std::max(linear_scale_, std::sqrt(2 * total_mass(simulation_) * e.kinetic));
    angular_scale_ = std::max(angular_scale_, simulation_.angular_momentum().norm());
    energy_ = std::max(energy_, std::abs(energy_account(simulation_) - balance_));
    linear_drift_ = std::max(linear_drift_, (simulation_.momentum() - linear_).norm());
    angular_drift_ = std::max(angular_drift_, (simulation_.angular_momentum() - angular_).norm());
  }
  double energy() const { return energy_ / energy_scale_; }  ///< drift of energy_account()
  double momentum() const { return linear_drift_ / linear_scale_; }
  double angular_momentum() const { return angular_drift_ / angular_scale_; }

 private:
  const Simulation& simulation_;
  double balance_;
  Vector3 linear_, angular_;
  double energy_ = 0, linear_drift_ = 0, angular_drift_ = 0;
  double energy_scale_ = 0, linear_scale_ = 0, angular_scale_ = 0;
};

}  // namespace flexarm::test
