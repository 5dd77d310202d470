#pragma once
/// Values and gradients of the constraints that close a loop, and the derivatives of the gradients. (joints.md 3)

#include "model/joint.h"
#include "model/loop_closure.h"

namespace flexarm {

/// The poses of a closure's two nodes.
struct ClosurePoses {
  NodePose parent, child;
};

/// Gradient of a constraint: the derivative of its value with respect to {displacement, spin} of the nodes.
struct ClosureRows {
  Vector6 parent, child;
};

/// A constraint over a step. `left` times the multiplier is added to the nodes' residuals. The blocks are the
/// derivatives of `left` with respect to {displacement, spin} at the end. `right` is the gradient of `value`.
struct ClosureMaps {
  double value;  ///< of the constraint at the end; 0 if it holds
  ClosureRows left, right;
  Matrix6 parent_parent, parent_child, child_parent, child_child;
};

/// Returns the value of a constraint; 0 if it holds.
double closure_value(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses);
/// Returns the gradient of the value.
ClosureRows closure_rows(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses);

/// Computes the maps of a constraint over a step. `end_weight`: weight of the end of the step in the vectors of the
/// left rows. With 1/2 the left rows are a discrete gradient: their product with the nodes' {Delta r, tangent-scaled
/// rotation increment} is exactly the change of the value, so multipliers do no work. Their forces then also conserve
/// momenta, since they act at the mean positions. With 1 the left rows are the gradient at the end.
void closure_maps(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& begin,
                  const ClosurePoses& end, double end_weight, ClosureMaps& maps);

}  // namespace flexarm
