#include "elements/load.h"

#include "math/so3.h"

namespace flexarm {

using so3::hat;

LoadAction load_action(const NodalLoad& load, double scale, const Matrix3& begin, const Matrix3& end, LoadPoint point) {
  const double weight = point == LoadPoint::Mean ? 0.5 : 1.0;
  const Matrix3 rotation = weight * end + (1 - weight) * begin;
  const Vector3 arm = rotation * load.arm;
  Vector3 force = scale * load.force, moment = scale * load.moment;
  // d(rotation x) = -weight (end x)^ spin
  Matrix3 force_derivative = Matrix3::Zero(), moment_derivative = Matrix3::Zero();
  if (load.follows) {
    force_derivative = -weight * hat(Vector3(end * force));
    moment_derivative = -weight * hat(Vector3(end * moment));
    force = rotation * force;
    moment = rotation * moment;
  }
  LoadAction action;
  action.wrench << force, moment + arm.cross(force);
  action.derivative.topRows<3>() = force_derivative;
  action.derivative.bottomRows<3>() =
      moment_derivative + hat(arm) * force_derivative + weight * hat(force) * hat(Vector3(end * load.arm));
  return action;
}

PullAction pull_action(const NodalLoad& load, const Vector3& target, const NodePose& begin, const NodePose& end,
                       double step, LoadPoint point) {
  const double weight = point == LoadPoint::Mean ? 0.5 : 1.0;
  const double stiffness = load.pull.stiffness, damper = step != 0 ? load.pull.damping / step : 0.0;
  const Vector3 end_arm = end.rotation * load.arm;
  const Vector3 arm = weight * end_arm + (1 - weight) * (begin.rotation * load.arm);
  const Vector3 increment = end.position + end_arm - begin.position - begin.rotation * load.arm;
  const Vector3 place = end.position + end_arm - (1 - weight) * increment;
  const Vector3 force = stiffness * (target - place) - damper * increment;
  PullAction action;
  action.wrench << force, arm.cross(force);
  // d(point at the end) = displacement - (end arm)^ spin
  const double slope = weight * stiffness + damper;
  const Matrix3 turn = hat(end_arm), lever = hat(arm);
  action.derivative << -slope * Matrix3::Identity(), slope * turn, -slope * lever,
      slope * lever * turn + weight * hat(force) * turn;
  const Vector3 mean_place = end.position + end_arm - 0.5 * increment;
  action.work = (stiffness * (target - mean_place) - damper * increment).dot(increment);
  return action;
}

}  // namespace flexarm
