#pragma once
/// Tells that the simulation is slower than it is asked to be.

#include <chrono>
#include <cstdint>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// Where steps have been dropped since the last warning, not too often: how many, and why.
class SlownessWarning {
 public:
  explicit SlownessWarning(const RunState& run) : run_(run) {}

  /// After a step: `seconds` it took by the clock on the wall, `time` simulated at its end [s].
  void note(double seconds, double time, const StepResult& result);
  /// Now and then. `step` [s]
  void warn_if_slow(double step);

 private:
  struct Step {
    double seconds = 0, time = 0;
    StepCounts counts;  // of this step alone
  };

  const RunState& run_;
  Step slowest_;  // since the last warning
  std::uint64_t warned_overruns_ = 0;
  std::chrono::steady_clock::time_point last_warning_;
};

}  // namespace flexarm::node
