#pragma once
/// How the run is going, apart from the state of the arm.

#include <cstdint>
#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

struct RunState {
  bool paused = false;
  std::string failure;  ///< why the last step failed; empty: it did not
  StepResult last_step;
  std::uint64_t steps = 0;     ///< that were done, since the node started
  StepCounts counts;           ///< of these and of those that failed
  std::uint64_t overruns = 0;  ///< steps dropped since the node started
  double simulated_time = 0;   ///< since the node started; a reset does not set it back [s]

  bool failed() const { return !failure.empty(); }
};

}  // namespace flexarm::node
