#pragma once
/// The interface by which Newmark's family gets accelerations that do not follow from a step before.

#include "flexarm/model/results.h"
#include "model/state.h"

namespace flexarm {

class AccelerationFinder {
 public:
  virtual ~AccelerationFinder() = default;

  /// Sets the accelerations of a state at the start of a motion, by a short step.
  /// @returns the result of that step; if it failed, the accelerations stay as they are
  virtual StepResult find(State& state) = 0;
  /// The same during a motion, before a step of this length [s]. Velocities that have drifted off the joints return to
  /// them first.
  virtual void renew(State& state, double step) = 0;
};

}  // namespace flexarm
