#pragma once
/// Computes the efforts that hold held joints, which have no unknown.

#include "integrators/joint_reactions.h"
#include "integrators/nodal_forces.h"
#include "integrators/scheme_family.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"
#include "solver/reduced_residual.h"

namespace flexarm {

/// The rate of momentum of the rigid links that a held joint carries, as {force, moment about their centre of mass}, in
/// world axes. `node`: of the joint's master, to which they belong.
Vector6 momentum_rate(const HeldJoint& held, const NodeState& node);

/// A held joint does not appear in the balance of a step. Its effort is the component along its axis of the wrench that
/// it transmits: the rate of momentum of the rigid links that it carries, minus their loads, plus what the joints
/// outboard transmit. All of these are known after the step, so that the step itself costs nothing more.
/// (docs/notes/joints.md 2.1)
class HeldEfforts {
 public:
  HeldEfforts(const StepConfiguration& configuration, const StepHistories& histories, const NodalForces& forces,
              const JointReactions& reactions, const SchemeFamily& family)
      : configuration_(configuration), histories_(histories), forces_(forces), reactions_(reactions), family_(family) {}

  /// The effort over the step, or at its end in the Newmark family [N or N m].
  /// @param residual  as it is after the step
  double effort(const HeldJoint& held, const ReducedResidual& residual);

 private:
  /// Adds the rate of momentum of the links as {force, moment about the centre of mass} to `wrench`.
  void add_inertia(const HeldJoint& held, int node, Vector6& wrench) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  const NodalForces& forces_;
  const JointReactions& reactions_;
  const SchemeFamily& family_;
  FoldMaps maps_;
};

}  // namespace flexarm
