#pragma once
/// How the run is going, apart from the state of the arm.

#include <cstdint>
#include <string>

#include "duration_histogram.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

struct RunState {
  bool paused = false;
  bool lock_step = false;  ///< each step waits for a command
  std::string failure;     ///< why the last step failed; empty: it did not
  StepResult last_step;
  std::uint64_t steps = 0;                 ///< that were done, since the node started
  StepCounts counts;                       ///< of these and of those that failed
  std::uint64_t overruns = 0;              ///< steps dropped since the node started
  std::uint64_t missed = 0;                ///< steps whose states were passed over
  std::uint64_t cut = 0;                   ///< steps of which only a part was done in time
  DurationHistogram step_times, lateness;  ///< since it was started or resumed
  double simulated_time = 0;               ///< since the node started; a reset does not set it back [s]

  bool failed() const { return !failure.empty(); }
  /// Nothing may come for long.
  bool waits() const { return paused || lock_step; }
};

}  // namespace flexarm::node
