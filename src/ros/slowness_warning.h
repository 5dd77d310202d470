#pragma once
/// Warns if the simulation is slower than it should be.

#include <chrono>
#include <cstdint>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// If steps were dropped since the last warning, warns how many, and why; at most every 10 s.
class SlownessWarning {
 public:
  explicit SlownessWarning(const RunState& run) : run_(run) {}

  /// Notes a step that took `seconds` of wall time; `time`: simulated time at its end [s].
  void note(double seconds, double time, const StepResult& result);
  /// To be called regularly. `step`: length of a step [s]
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
