#pragma once
/// Rows of the constraints that close a loop, and their derivatives. (joints.md 3)

#include "model/joint.h"
#include "model/loop_closure.h"

namespace flexarm {

/// The poses of a closure's two nodes.
struct ClosurePoses {
  NodePose parent, child;
};

/// A constraint's rows: derivative of its value with respect to {displacement, spin} of the nodes.
struct ClosureRows {
  Vector6 parent, child;
};

/// `left`, times the multiplier, is what the closure adds to the nodes' residuals; its derivative with respect to
/// {displacement, spin} at the end are the blocks. `right` is the derivative of `value`.
struct ClosureMaps {
  double value;  ///< of the constraint at the end; 0 where it holds
  ClosureRows left, right;
  Matrix6 parent_parent, parent_child, child_parent, child_child;
};

/// Value of a constraint, 0 where it holds.
double closure_value(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses);
/// Its derivative.
ClosureRows closure_rows(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses);

/// `end_weight`: of the end in the vectors of the left rows. With 1/2 they are a discrete gradient: over a step their
/// product with the nodes' {Delta r, tangent-scaled rotation increment} is the change of the value, exactly, so that
/// multipliers do no work; and forces at mean positions add up to no momentum. 1: the gradient at the end.
void closure_maps(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& begin,
                  const ClosurePoses& end, double end_weight, ClosureMaps& maps);

}  // namespace flexarm
