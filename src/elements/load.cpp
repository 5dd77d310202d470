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

}  // namespace flexarm
