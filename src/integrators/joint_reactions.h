#pragma once
/// Computes forces and moments in joints over a step, for sensors. Only for the joints that the model lists.

#include "integrators/loop_multipliers.h"
#include "integrators/step_configuration.h"
#include "solver/reduced_residual.h"

namespace flexarm {

/// When everything outboard of a slave is folded, the residual of the slave is the wrench by its joint. This wrench
/// equals exactly the rate of momentum of everything outboard in the step, minus its loads. For a loop joint,
/// multipliers give the wrench on the closure's child directly; the other link gets the opposite wrench. Moments are
/// about a point of the link, in the same step: so a hinge has none about its axis if the point is on it.
class JointReactions {
 public:
  JointReactions(const StepConfiguration& configuration, const LoopMultipliers& loops)
      : configuration_(configuration), loops_(loops) {}

  /// Adds to State::transmitted. To be called before the rest of the state is written.
  void accept(const ReducedResidual& residual, State& state) const;
  /// The same for an equilibrium.
  void accept_rest(const ReducedResidual& residual, State& state) const;
  /// {force, moment about `place.point`} over the step, or at its end in the Newmark family; world axes [N, N m].
  /// @param residual  as it is after the step
  Vector6 transmitted(const ReducedResidual& residual, const ReactionPlace& place) const;

 private:
  const StepConfiguration& configuration_;
  const LoopMultipliers& loops_;
};

}  // namespace flexarm
