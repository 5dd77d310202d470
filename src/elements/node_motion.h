#pragma once
/// The motion of a node at the end of a step of a conserving scheme, and of an equilibrium.

#include <cassert>

#include "math/cayley.h"
#include "model/joint.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// Converts the tangent-scaled rotation increment of a step into the one that the scheme's rule for the angular
/// velocities of nodes uses [rad].
inline Vector3 counted_rotation(const TimeRule& rule, const Vector3& tangent_scaled) {
  return rule.body_rotation == RotationRule::TangentScaled ? tangent_scaled
                                                           : cayley::to_rotation_vector(tangent_scaled);
}

/// Returns a node that rests in this pose.
inline NodeState at_rest(const NodePose& pose) {
  NodeState out;
  out.position = pose.position;
  out.orientation = pose.orientation;
  return out;
}

/// Returns the node's motion at the end of the step: v_1 = factor Delta r / h - (factor - 1) v_0, and
/// (W_0 + W_1) / 2 = Omega / h. `state`: at the beginning; `increment`: of rotation, tangent-scaled; `step` [s].
inline NodeState advanced(const TimeRule& rule, const NodePose& begin, const NodePose& end, const NodeState& state,
                          const Vector3& increment, double step) {
  assert(rule.is_incremental() && step != 0);
  NodeState out = at_rest(end);
  const Vector3 displacement = end.position - begin.position;
  const Matrix3 to_material = begin.rotation.transpose();
  const double factor = rule.velocity_factor();
  out.velocity = (factor / step) * displacement - (factor - 1) * state.velocity;
  out.angular_velocity = (2 / step) * (to_material * counted_rotation(rule, increment)) - state.angular_velocity;
  return out;
}

/// Returns d(Lambda J W)/dt [N m], for the material angular velocity W and acceleration A.
inline Vector3 momentum_rate(const Matrix3& rotation, const Matrix3& inertia, const Vector3& W, const Vector3& A) {
  return rotation * (W.cross(inertia * W) + inertia * A);
}

}  // namespace flexarm
