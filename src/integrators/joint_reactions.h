#pragma once
/// Forces in joints over a step, for output, of those joints that the model names.

#include "integrators/loop_multipliers.h"
#include "integrators/step_configuration.h"
#include "solver/reduced_residual.h"

namespace flexarm {

/// The residual of a slave, once all that hangs on it has been folded, is what its joint does to it: exactly that by
/// which the momenta of what hangs on it change in the step, less its loads. Moments are about the origin of the link
/// that the slave carries. What multipliers do to a closure's child is known as it is; what a loop joint does to its
/// other link is the opposite.
class JointReactions {
 public:
  JointReactions(const StepConfiguration& configuration, const LoopMultipliers& loops)
      : configuration_(configuration), loops_(loops) {}

  /// Adds to State::transmitted, before the rest of the state is written.
  void accept(const ReducedResidual& residual, State& state) const;
  /// The same of an equilibrium.
  void accept_rest(const ReducedResidual& residual, State& state) const;
  /// {force, moment about the link's origin} over the step, or at its end in the Newmark family; world axes [N, N m].
  /// @param residual  as the step left it
  Vector6 transmitted(const ReducedResidual& residual, const ReactionPlace& place) const;

 private:
  const StepConfiguration& configuration_;
  const LoopMultipliers& loops_;
};

}  // namespace flexarm
