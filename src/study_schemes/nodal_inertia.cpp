#include "study_schemes/nodal_inertia.h"

#include <cassert>

#include "elements/conserving_node.h"
#include "study_schemes/rotary_inertia.h"

namespace flexarm {
namespace {

MassPointState spin_state(const NodeState& state) {
  return {state.angular_velocity, state.angular_acceleration};
}

}  // namespace

NewmarkRule newmark_rule(const TimeRule& rule, double step) {
  return {rule.beta, rule.gamma, step, rule.hht == HhtForm::Kinematics ? rule.alpha : 0.0};
}

NodalAction nodal_inertia_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node,
                                 bool with_tangent) {
  assert(node.step != 0);
  NodalAction action;
  const double h = node.step;
  const Matrix3& begin = node.begin.rotation;
  const Matrix3& end = node.end.rotation;
  const Vector3 displacement = node.end.position - node.begin.position;
  Matrix3 J = inertia.rotary;
  if (rule.nodal_rotary_inertia) J += inertia.beam_rotary;
  const MassPointState spin = spin_state(node.state);
  if (rule.is_incremental()) {
    const Vector3 increment = counted_rotation(rule, node.increment);
    const bool is_unscaled = rule.body_rotation == RotationRule::Unscaled;
    const Matrix3 inverse_tangent = is_unscaled ? so3::inverse_tangent(increment) : node.inverse_tangent;
    const ConservingNode<double> conserving(
        {inertia.mass, J},
        {begin, end, displacement, increment, inverse_tangent, node.state.velocity, spin.angular_velocity},
        rule.velocity_factor(), h, with_tangent);
    action.residual = conserving.residual;
    action.translational = conserving.translational;
    if (with_tangent) action.rotational = conserving.rotational;
    return action;
  }
  const NewmarkRule newmark = newmark_rule(rule, h);
  action.residual.head<3>() =
      inertia.mass * newmark.acceleration(displacement, node.state.velocity, node.state.acceleration);
  action.translational = inertia.mass * newmark.acceleration_slope();
  if (J.isZero(0)) return action;
  const RotaryRate rate = rule.hht == HhtForm::None
                              ? newmark_rotary_rate(J, begin, end, spin, newmark)
                              : momentum_rotary_rate(J, begin, end, spin, node.momentum_rate, newmark);
  action.residual.tail<3>() = rate.moment;
  if (with_tangent) action.rotational = rate.derivative;
  return action;
}

NodalAction nodal_damping_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node,
                                 bool with_tangent) {
  assert(node.step != 0);
  NodalAction action;
  const Matrix3& D = inertia.rotary_damping;
  if (D.isZero(0)) return action;
  const Matrix3& begin = node.begin.rotation;
  const Matrix3& end = node.end.rotation;
  if (rule.is_incremental()) {
    const NodeDamping<double> damping(D, {begin, end, {}, node.increment, node.inverse_tangent, {}, {}}, node.step,
                                      with_tangent);
    action.residual.tail<3>() = damping.moment;
    if (with_tangent) action.rotational = damping.derivative;
    action.dissipated = damping.dissipated;
    return action;
  }
  const NewmarkRule newmark = newmark_rule(rule, node.step);
  const MassPointState spin = spin_state(node.state);
  const Vector3 increment = so3::log(Matrix3(end * begin.transpose()));
  const Vector3 A =
      newmark.acceleration(begin.transpose() * increment, spin.angular_velocity, spin.angular_acceleration);
  const Vector3 moment = end * (D * newmark.velocity(spin.angular_velocity, spin.angular_acceleration, A));
  action.residual.tail<3>() = (1 + newmark.alpha) * moment - newmark.alpha * (begin * (D * spin.angular_velocity));
  if (with_tangent)
    action.rotational =
        (1 + newmark.alpha) *
        (end * D * begin.transpose() * so3::inverse_tangent(increment) * newmark.velocity_slope() - so3::hat(moment));
  action.dissipated = action.residual.tail<3>().dot(increment);
  return action;
}

NodeState advanced(const TimeRule& rule, const NodeStep& node) {
  assert(node.step != 0);
  if (rule.is_incremental()) return advanced(rule, node.begin, node.end, node.state, node.increment, node.step);
  const NewmarkRule newmark = newmark_rule(rule, node.step);
  const NodeState& state = node.state;
  NodeState out;
  out.position = node.end.position;
  out.orientation = node.end.orientation;
  const Matrix3 to_material = node.begin.rotation.transpose();
  const Vector3 increment = to_material * cayley::to_rotation_vector(node.increment);
  out.acceleration = newmark.acceleration(node.end.position - node.begin.position, state.velocity, state.acceleration);
  out.velocity = newmark.velocity(state.velocity, state.acceleration, out.acceleration);
  out.angular_acceleration = newmark.acceleration(increment, state.angular_velocity, state.angular_acceleration);
  out.angular_velocity = newmark.velocity(state.angular_velocity, state.angular_acceleration, out.angular_acceleration);
  return out;
}

}  // namespace flexarm
