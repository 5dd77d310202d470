#include "joints/closure_maps.h"

#include <cassert>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// The vectors in a constraint, in world axes, at one instant or averaged over two.
struct Vectors {
  Vector3 normal;                 // fixed to the parent
  Vector3 parent_arm, other;      // other: the child's arm (Gap) or direction (Direction)
  Vector3 gap = Vector3::Zero();  // from the parent's point to the child's point
};

Vectors vectors(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses) {
  Vectors out;
  out.normal = poses.parent.rotation * constraint.normal;
  out.parent_arm = poses.parent.rotation * closure.parent_arm;
  const bool is_gap = constraint.kind == ClosureConstraint::Kind::Gap;
  out.other = poses.child.rotation * (is_gap ? closure.child_arm : constraint.direction);
  if (is_gap) out.gap = poses.child.position + out.other - poses.parent.position - out.parent_arm;
  return out;
}

Vectors mean(const Vectors& begin, const Vectors& end, double weight) {
  const auto mix = [&](const Vector3& a, const Vector3& b) { return Vector3((1 - weight) * a + weight * b); };
  return {mix(begin.normal, end.normal), mix(begin.parent_arm, end.parent_arm), mix(begin.other, end.other),
          mix(begin.gap, end.gap)};
}

ClosureRows rows(ClosureConstraint::Kind kind, const Vectors& v) {
  ClosureRows out;
  const Vector3 turn = v.other.cross(v.normal);
  if (kind == ClosureConstraint::Kind::Direction) {
    out.child << Vector3::Zero(), turn;
    out.parent << Vector3::Zero(), -turn;
  } else {
    out.child << v.normal, turn;
    out.parent << -v.normal, v.normal.cross(v.parent_arm + v.gap);
  }
  return out;
}

}  // namespace

double closure_value(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses) {
  const Vectors v = vectors(closure, constraint, poses);
  return constraint.kind == ClosureConstraint::Kind::Gap ? v.gap.dot(v.normal)
                                                         : v.other.dot(v.normal) - constraint.value;
}

ClosureRows closure_rows(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& poses) {
  return rows(constraint.kind, vectors(closure, constraint, poses));
}

void closure_maps(const LoopClosure& closure, const ClosureConstraint& constraint, const ClosurePoses& begin,
                  const ClosurePoses& end, double w, ClosureMaps& maps) {
  assert(w >= 0 && w <= 1);
  const Vectors at_end = vectors(closure, constraint, end);
  const Vectors v = mean(vectors(closure, constraint, begin), at_end, w);
  maps.value = closure_value(closure, constraint, end);
  maps.left = rows(constraint.kind, v);
  maps.right = rows(constraint.kind, at_end);
  for (Matrix6* block : {&maps.parent_parent, &maps.parent_child, &maps.child_parent, &maps.child_child})
    block->setZero();

  // Vectors at the end of the step rotate with their nodes: d(normal) = -normal^ spin.
  const Matrix3 d_normal = -w * hat(at_end.normal), d_other = -w * hat(at_end.other);
  const Matrix3 moment_normal = hat(v.other) * d_normal, moment_other = -hat(v.normal) * d_other;
  maps.child_parent.bottomRightCorner<3, 3>() = moment_normal;
  maps.child_child.bottomRightCorner<3, 3>() = moment_other;
  if (constraint.kind == ClosureConstraint::Kind::Direction) {
    maps.parent_parent.bottomRightCorner<3, 3>() = -moment_normal;
    maps.parent_child.bottomRightCorner<3, 3>() = -moment_other;
    return;
  }
  maps.child_parent.topRightCorner<3, 3>() = d_normal;
  maps.parent_parent.topRightCorner<3, 3>() = -d_normal;
  // In normal x (parent_arm + gap), the sum is the child's point minus the parent's node: the parent's arm cancels.
  const Matrix3 n = hat(v.normal);
  maps.parent_parent.bottomLeftCorner<3, 3>() = -w * n;
  maps.parent_parent.bottomRightCorner<3, 3>() = -hat(Vector3(v.parent_arm + v.gap)) * d_normal;
  maps.parent_child.bottomLeftCorner<3, 3>() = w * n;
  maps.parent_child.bottomRightCorner<3, 3>() = n * d_other;
}

}  // namespace flexarm
