#include "elements/spring_action.h"

#include <algorithm>
#include <limits>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// World axes, at one instant or in the mean of two.
struct Vectors {
  Vector3 child_arm, parent_arm;
  Vector3 distance;  // from the parent's to the child's point
};

Vectors vectors(const LoopClosure& ends, const ClosurePoses& poses) {
  Vectors out;
  out.child_arm = poses.child.rotation * ends.child_arm;
  out.parent_arm = poses.parent.rotation * ends.parent_arm;
  out.distance = poses.child.position + out.child_arm - poses.parent.position - out.parent_arm;
  return out;
}

Vectors mean(const Vectors& a, const Vectors& b, double weight) {
  const auto mix = [&](const Vector3& x, const Vector3& y) { return Vector3((1 - weight) * x + weight * y); };
  return {mix(a.child_arm, b.child_arm), mix(a.parent_arm, b.parent_arm), mix(a.distance, b.distance)};
}

/// A length by which may be divided: a spring of no length pulls nowhere.
double divisor(double length) {
  return std::max(length, std::numeric_limits<double>::min());
}

}  // namespace

double spring_length(const LoopClosure& ends, const ClosurePoses& poses) {
  return vectors(ends, poses).distance.norm();
}

Vector12 spring_gradient(const LoopClosure& ends, const ClosurePoses& poses) {
  const Vectors v = vectors(ends, poses);
  const Vector3 along = v.distance / divisor(v.distance.norm());
  Vector12 gradient;
  gradient << along, v.child_arm.cross(along), -along, -v.parent_arm.cross(along);
  return gradient;
}

SpringAction spring_action(const PointSpring& spring, const LoopClosure& ends, const ClosurePoses& begin,
                           const ClosurePoses& end, const CoordinateStep& change) {
  const double weight = change.at_end ? 1 : 0.5;
  const Vectors at_end = vectors(ends, end), v = mean(vectors(ends, begin), at_end, weight);
  const double length = divisor((1 - weight) * change.begin + weight * change.end);
  const bool is_damped = change.step != 0 && spring.damping > 0;
  const double rate = is_damped ? rate_of(change) : 0, slope = is_damped ? rate_slope(change) : 0;
  const double density = (spring.stiffness * (length - spring.rest_length) + spring.damping * rate) / length;
  const Vector3 force = density * v.distance;

  SpringAction out;
  out.dissipated = spring.damping * rate * change.increment;
  out.child << force, v.child_arm.cross(force);
  out.parent << -force, -v.parent_arm.cross(force);

  // Of the distance at the end, by {displacement, spin} of child and parent.
  Eigen::Matrix<double, 3, 12> distance;
  distance << Matrix3::Identity(), -hat(at_end.child_arm), -Matrix3::Identity(), hat(at_end.parent_arm);
  const double density_slope = (weight * (spring.stiffness - density) + spring.damping * slope) / length;
  const Vector3 along = density_slope / divisor(change.end) * at_end.distance;
  const Eigen::Matrix<double, 3, 12> d_force =
      weight * density * distance + v.distance * (along.transpose() * distance);
  out.tangent << d_force, hat(v.child_arm) * d_force, -d_force, -hat(v.parent_arm) * d_force;
  // The arms turn with their nodes.
  out.tangent.block<3, 3>(3, 3) += weight * hat(force) * hat(at_end.child_arm);
  out.tangent.block<3, 3>(9, 9) -= weight * hat(force) * hat(at_end.parent_arm);
  return out;
}

}  // namespace flexarm
