#pragma once
/// The efforts that hold held joints.

#include "integrators/joint_reactions.h"
#include "integrators/nodal_forces.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"
#include "solver/reduced_residual.h"

namespace flexarm {

/// A held joint is no part of the balance. Its effort is what it transmits, seen along its axis: that by which the
/// momenta of the rigid links change which it carries, less their loads, plus what the joints outboard transmit. These
/// are known when the step is; nothing is evaluated before. (docs/notes/joints.md 2.1)
class HeldEfforts {
 public:
  HeldEfforts(const StepConfiguration& configuration, const StepHistories& histories, const NodalForces& forces,
              const JointReactions& reactions)
      : configuration_(configuration), histories_(histories), forces_(forces), reactions_(reactions) {}

  /// Over the step, or at its end in the Newmark family [N or N m].
  /// @param residual  as the step left it
  double effort(const HeldJoint& held, const ReducedResidual& residual);

 private:
  /// Adds {force, moment about the master} of what changes the momenta of the links.
  void add_inertia(const HeldJoint& held, int node, Vector6& wrench) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  const NodalForces& forces_;
  const JointReactions& reactions_;
  FoldMaps maps_;
};

}  // namespace flexarm
