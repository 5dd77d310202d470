#pragma once
/// The state of the run (paused, failed, counts of steps), as opposed to the mechanical state.

#include <cstdint>
#include <string>

#include "duration_histogram.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

struct RunState {
  bool paused = false;
  bool lock_step = false;  ///< each step waits for a command
  std::string failure;     ///< why the last step failed; empty: the last step succeeded
  StepResult last_step;
  std::uint64_t steps = 0;                 ///< successful steps since the node started
  StepCounts counts;                       ///< of successful and failed steps
  std::uint64_t overruns = 0;              ///< steps dropped since the node started
  std::uint64_t missed = 0;                ///< steps whose states were not published
  std::uint64_t cut = 0;                   ///< steps of which only a part was done in time
  DurationHistogram step_times, lateness;  ///< since the simulation was started or resumed
  double simulated_time = 0;               ///< since the node started; a reset does not set it back [s]

  bool failed() const { return !failure.empty(); }
  /// Whether no step may come for a long time.
  bool waits() const { return paused || lock_step; }
};

}  // namespace flexarm::node
