#include "joints/joint_map.h"

#include <cassert>
#include <cmath>

#include "math/cayley.h"
#include "math/simd.h"
#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Displacement of the moved joint frame, in the master node's frame.
Vector3 displacement(const JointMap& joint, const Released& released) {
  if (joint.kind != JointMapKind::Scalar) return joint.origin.orientation * released.displacement;
  const double u = released.displacement[0];
  return (joint.profile ? joint.profile->value(u) : u) * joint.translation;
}

/// Derivative (slope) of the travel f(u) at the end of a step, secant over the step, and the derivatives of both with
/// respect to u at the end.
struct TravelRate {
  double slope = 1, curvature = 0;
  double secant = 1, secant_derivative = 0;
};
TravelRate travel_rate(const JointMap& joint, double begin, double end) {
  if (!joint.profile) return {};
  const CamProfile& f = *joint.profile;
  return {f.derivative(end), f.second_derivative(end), f.secant(begin, end), f.secant_derivative(begin, end)};
}

/// Returns B, the orientation of the joint frame.
Matrix3 joint_rotation(const JointMap& joint, const NodePose& master) {
  return master.rotation * joint.origin.orientation.toRotationMatrix();
}

/// Returns the vector from the master node to the origin of the moved joint frame, Lambda_m b + B (displacement), in
/// world axes.
Vector3 lever_to_moved_frame(const JointMap& joint, const NodePose& master, const Released& released) {
  const bool travels =
      joint.kind != JointMapKind::Rigid && (joint.kind != JointMapKind::Scalar || !joint.translation.isZero(0));
  if (!travels) return master.rotation * joint.origin.position;
  return master.rotation * (joint.origin.position + displacement(joint, released));
}

void set_sizes(int count, FoldMaps& maps) {
  maps.left.setZero(6, count);
  maps.right.setZero(6, count);
  maps.released_released.setZero(count, count);
  maps.released_spin.setZero(count, 3);
  maps.moment_released.setZero(3, count);
}

/// Tangent-scaled rotation per unit scalar increment, h = 2 tan(x/2)/x for a rotation x, and dh/dx.
struct ScaledRate {
  double value, derivative;
};
ScaledRate scaled_rate(double x) {
  if (std::abs(x) < 0.05) {  // 2 tan(x/2)/x = 1 + x^2/12 + x^4/120 + 17 x^6/20160 + 31 x^8/362880 + ...
    const double y = x * x;
    return {1 + y * (1.0 / 12 + y * (1.0 / 120 + y * (17.0 / 20160 + y * 31.0 / 362880))),
            x * (1.0 / 6 + y * (1.0 / 30 + y * (17.0 / 3360 + y * 31.0 / 45360)))};
  }
  const double t = std::tan(0.5 * x);
  return {2 * t / x, ((1 + t * t) - 2 * t / x) / x};
}

/// A force and a moment about the origin of the moved joint frame.
struct WrenchAtFrame {
  Vector3 force, moment;
};

/// Adds lever arms to maps that were made for a wrench at the origin of the moved joint frame. The arms from the master
/// node to this origin are in `maps`; those from the origin to the slave node are `left` (for the left maps) and
/// `right` (at the end of the step). The result is the same as with rigid joints before and after the joint. `weight`:
/// weight of the end of the step in the left arms.
void add_arms(const Vector3& left, const Vector3& right, const Vector3& force, bool with_tangent, double weight,
              FoldMaps& maps) {
  const Eigen::Index count = maps.left.cols();
  // d(arm x force) = moment_rate(arm) * spin, for the slave's arm alone and for the sum of both arms.
  const auto moment_rate = [&](const Vector3& arm) {
    return Matrix3(weight * (arm * force.transpose()) - (weight * force.dot(arm)) * Matrix3::Identity());
  };
  maps.lever_left += left;
  maps.lever_right += right;
  if (with_tangent) {
    const Matrix3 rate = moment_rate(right);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Vector3 spin = maps.right.col(k).tail<3>(), moment = rate * spin;
      for (Eigen::Index i = 0; i < count; ++i) maps.released_released(i, k) += maps.left.col(i).tail<3>().dot(moment);
      maps.released_spin.row(k) += maps.left.col(k).tail<3>().transpose() * rate;
      maps.moment_released.col(k) += moment;
      maps.right.col(k).head<3>() += spin.cross(right);
    }
    maps.moment_spin = moment_rate(maps.lever_right);
  }
  for (Eigen::Index k = 0; k < count; ++k) maps.left.col(k).head<3>() += maps.left.col(k).tail<3>().cross(left);
}

/// Returns S(w)^-T v, with the tangent-scaled rotation increment w.
Vector3 transposed_inverse_tangent(const Vector3& w, const Vector3& v) {
  return v + 0.5 * w.cross(v) + (0.25 * w.dot(v)) * w;
}

/// Adds the travel to the maps of a joint with one coordinate. `w`: the master's rotation increment.
void add_travel(const JointMap& joint, const JointPose& begin, const JointPose& end, const Vector3& w,
                const Vector3& force, FoldMaps& maps, bool with_tangent, double arm_weight) {
  const Vector3 direction = begin.master.rotation * joint.translation;
  const Vector3 left_direction = direction + 0.5 * w.cross(direction);
  const TravelRate rate = travel_rate(joint, begin.released.displacement[0], end.released.displacement[0]);
  maps.left.col(0).head<3>() = rate.secant * left_direction;
  if (!with_tangent) return;
  const Vector3 travel = rate.slope * (end.master.rotation * joint.translation);
  maps.right.col(0).head<3>() = travel;
  maps.released_released(0, 0) += rate.secant_derivative * force.dot(left_direction);
  maps.released_spin.row(0) += transposed_inverse_tangent(w, 0.5 * rate.secant * direction.cross(force)).transpose();
  maps.moment_released.col(0) = -arm_weight * force.cross(travel);
}

/// Maps of joints with one coordinate, without lever arms. The formulas are those of incremental_matrix_maps(), applied
/// to the axis of rotation and the direction of travel, so that vectors replace matrices.
void incremental_scalar_maps(const JointMap& joint, const JointPose& begin, const JointPose& end,
                             const WrenchAtFrame& g, FoldMaps& maps, bool with_tangent, double arm_weight) {
  const Vector3 axis = begin.master.rotation * joint.rotation;
  const Vector3 w = cayley::increment(begin.master.orientation, end.master.orientation);
  const double step = end.released.displacement[0] - begin.released.displacement[0], angle = joint.rotation.norm();
  const ScaledRate rate = scaled_rate(step * angle);
  const Vector3 turn = rate.value * step * axis;
  const double c = 1 / (1 - 0.25 * w.dot(turn));
  const Vector3 left_axis = c * transposed_inverse_tangent(w, axis);
  maps.left.resize(6, 1);
  maps.left.col(0) << Vector3::Zero(), rate.value * left_axis;
  if (with_tangent) {
    const double axis_moment = left_axis.dot(g.moment), turned = w.dot(axis);
    const Vector3 varied = 0.5 * g.moment.cross(axis) - (0.25 * turned) * g.moment - (0.25 * w.dot(g.moment)) * axis;
    maps.right.resize(6, 1);
    maps.right.col(0) << Vector3::Zero(), end.master.rotation * joint.rotation;
    maps.released_released.resize(1, 1);
    maps.released_released(0, 0) = rate.derivative * angle * axis_moment +
                                   rate.value * axis_moment * 0.25 * c * turned * (1 + 0.25 * turn.squaredNorm());
    maps.released_spin.resize(1, 3);
    maps.released_spin.row(0) =
        transposed_inverse_tangent(w, (rate.value * c) * (0.25 * axis_moment * turn - varied)).transpose();
    maps.moment_released.setZero(3, 1);
  }
  if (!joint.translation.isZero(0)) add_travel(joint, begin, end, w, g.force, maps, with_tangent, arm_weight);
}

/// Maps of joints without coordinates or with free rotations, without lever arms.
void incremental_matrix_maps(const JointMap& joint, const JointPose& begin, const JointPose& end,
                             const WrenchAtFrame& g, FoldMaps& maps, bool with_tangent, double arm_weight) {
  const int count = released_count(joint.kind);
  if (with_tangent)
    set_sizes(count, maps);
  else
    maps.left.setZero(6, count);
  if (joint.kind == JointMapKind::Rigid) return;

  // Rows that are conjugate to the relative translation and to the tangent-scaled relative rotation, in the joint
  // frame.
  const Matrix3 B0 = joint_rotation(joint, begin.master);
  const Vector3 w = cayley::increment(begin.master.orientation, end.master.orientation);
  const Matrix3 S_inverse = cayley::inverse_tangent(w);
  const Vector3 turn = released_increment(joint, begin.released, end.released).tail<3>(), turn_world = B0 * turn;
  const double c = 1 / (1 - 0.25 * w.dot(turn_world));
  const Matrix3 N22 = c * S_inverse.transpose() * B0;
  if (joint.kind == JointMapKind::Free) maps.left.topLeftCorner<3, 3>() = B0 + 0.5 * hat(w) * B0;
  maps.left.bottomRightCorner<3, 3>() = N22;
  if (!with_tangent) return;

  const Matrix3 rotation = joint_rotation(joint, end.master);
  const Vector3 row_phi = N22.transpose() * g.moment, w_joint = B0.transpose() * w;
  if (joint.kind == JointMapKind::Free) {
    maps.right.topLeftCorner<3, 3>() = rotation;
    maps.released_spin.topRows<3>() = 0.5 * B0.transpose() * hat(g.force) * S_inverse;
    maps.moment_released.leftCols<3>() = -arm_weight * hat(g.force) * rotation;
  }
  maps.right.bottomRightCorner<3, 3>() = rotation;
  maps.released_released.bottomRightCorner<3, 3>() =
      0.25 * c * row_phi * w_joint.transpose() * cayley::inverse_tangent(turn);
  maps.released_spin.bottomRows<3>() =
      (c * B0.transpose() * cayley::xi_inverse_tangent(w, g.moment) + 0.25 * c * row_phi * turn_world.transpose()) *
      S_inverse;
}

// The functions below take most of the time of a rigid arm's step. Fused multiply-add saves a quarter of that time.
NodePose pose_at_arm(const JointMap& joint, const NodePose& master, const Released& released) {
  Quaternion turned = master.orientation;
  if (joint.kind == JointMapKind::Scalar)
    turned = turned * so3::exp_quaternion(released.displacement[0] * joint.rotation);
  else
    turned = turned * joint.origin.orientation * released.rotation;
  NodePose slave;
  slave.orientation = (turned * joint.slave_orientation).normalized();
  slave.rotation = slave.orientation.toRotationMatrix();
  slave.position = master.position + lever_to_moved_frame(joint, master, released) + slave.rotation * joint.arm;
  return slave;
}

void incremental_maps_with_arms(const JointMap& joint, const JointPose& begin, const JointPose& end, const Vector6& g,
                                FoldMaps& maps, bool with_tangent, double arm_weight) {
  const auto mean = [&](const Vector3& at_begin, const Vector3& at_end) {
    return Vector3((1 - arm_weight) * at_begin + arm_weight * at_end);
  };
  maps.lever_right = lever_to_moved_frame(joint, end.master, end.released);
  maps.lever_left = mean(lever_to_moved_frame(joint, begin.master, begin.released), maps.lever_right);
  const Vector3 arm_right = end.slave.rotation * joint.arm;
  const Vector3 arm_left = mean(begin.slave.rotation * joint.arm, arm_right);
  const WrenchAtFrame at_frame{g.head<3>(), g.tail<3>() + arm_left.cross(g.head<3>())};
  if (joint.kind == JointMapKind::Scalar)
    incremental_scalar_maps(joint, begin, end, at_frame, maps, with_tangent, arm_weight);
  else
    incremental_matrix_maps(joint, begin, end, at_frame, maps, with_tangent, arm_weight);
  add_arms(arm_left, arm_right, at_frame.force, with_tangent, arm_weight, maps);
}

}  // namespace

NodePose slave_pose(const JointMap& joint, const NodePose& master, const Released& released) {
  assert(joint.kind != JointMapKind::Slide && "slide_pose() has it");
  NodePose slave;
  simd::run([&] { slave = pose_at_arm(joint, master, released); });
  return slave;
}

Released updated(const JointMap& joint, const Released& released, const Eigen::Ref<const ReleasedVector>& increment) {
  assert(increment.size() == released_count(joint.kind));
  Released out = released;
  if (joint.kind == JointMapKind::Scalar || joint.kind == JointMapKind::Slide) {
    out.displacement[0] += increment[0];
  } else if (joint.kind != JointMapKind::Rigid) {
    if (joint.kind == JointMapKind::Free) out.displacement += increment.head<3>();
    const Vector3 spin = increment.tail<3>();
    out.rotation = (so3::exp_quaternion(spin) * released.rotation).normalized();
  }
  return out;
}

ReleasedVector released_increment(const JointMap& joint, const Released& from, const Released& to) {
  ReleasedVector out(released_count(joint.kind));
  if (joint.kind == JointMapKind::Scalar || joint.kind == JointMapKind::Slide) {
    out[0] = to.displacement[0] - from.displacement[0];
  } else if (joint.kind != JointMapKind::Rigid) {
    if (joint.kind == JointMapKind::Free) out.head<3>() = to.displacement - from.displacement;
    out.tail<3>() = cayley::increment(from.rotation, to.rotation);
  }
  return out;
}

void variational_maps(const JointMap& joint, const JointPose& pose, const Vector6& g, FoldMaps& maps) {
  assert(joint.kind != JointMapKind::Slide && "slide_variational_maps() has them");
  const int count = released_count(joint.kind);
  const Matrix3 rotation = joint_rotation(joint, pose.master);
  const Vector3 arm = pose.slave.rotation * joint.arm;
  const Vector3 force = g.head<3>(), moment = g.tail<3>() + arm.cross(force);
  set_sizes(count, maps);

  switch (joint.kind) {
    case JointMapKind::Rigid:
    case JointMapKind::Slide:  // its maps are in slide_map.h
      break;
    case JointMapKind::Scalar: {
      const double u = pose.released.displacement[0];
      const TravelRate rate = travel_rate(joint, u, u);
      const Vector3 direction = rotation * joint.translation, turn = rotation * joint.rotation;
      const Vector3 travel = rate.slope * direction;
      maps.right.col(0) << travel, turn;
      maps.released_released(0, 0) = rate.curvature * force.dot(direction);
      maps.released_spin.row(0) = -(force.cross(travel) + moment.cross(turn)).transpose();
      maps.moment_released.col(0) = -force.cross(travel);
      break;
    }
    case JointMapKind::Free:
      maps.right.topLeftCorner<3, 3>() = rotation;
      maps.released_spin.topRows<3>() = rotation.transpose() * hat(force);
      maps.moment_released.leftCols<3>() = -hat(force) * rotation;
      [[fallthrough]];
    case JointMapKind::Spherical:
      maps.right.bottomRightCorner<3, 3>() = rotation;
      maps.released_spin.bottomRows<3>() = rotation.transpose() * hat(moment);
      break;
  }
  maps.left = maps.right;
  maps.lever_left = maps.lever_right = lever_to_moved_frame(joint, pose.master, pose.released);
  add_arms(arm, arm, force, true, 1, maps);
}

void incremental_maps(const JointMap& joint, const JointPose& begin, const JointPose& end, const Vector6& g,
                      FoldMaps& maps, bool with_tangent, double arm_weight) {
  assert(joint.kind != JointMapKind::Slide && "slide_incremental_maps() has them");
  assert(arm_weight >= 0 && arm_weight <= 1);
  simd::run([&] { incremental_maps_with_arms(joint, begin, end, g, maps, with_tangent, arm_weight); });
}

Vector6 slave_velocity(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                       const Eigen::Ref<const ReleasedVector>& rates) {
  assert(rates.size() == released_count(joint.kind));
  FoldMaps maps;
  variational_maps(joint, pose, Vector6::Zero(), maps);
  Vector6 velocity = master_velocity;
  velocity.head<3>() += master_velocity.tail<3>().cross(maps.lever_right);
  velocity.noalias() += maps.right * rates;
  return velocity;
}

ReleasedVector released_rates(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                              const Vector6& slave_velocity, Vector6* remainder) {
  FoldMaps maps;
  variational_maps(joint, pose, Vector6::Zero(), maps);
  Vector6 relative = slave_velocity - master_velocity;
  relative.head<3>() -= master_velocity.tail<3>().cross(maps.lever_right);
  // At the origin of the moved frame, the columns are orthogonal for every kind of joint.
  const Vector3 arm = pose.slave.rotation * joint.arm;
  const auto at_frame = [&](Vector6 velocity) {
    velocity.head<3>() -= velocity.tail<3>().cross(arm);
    return velocity;
  };
  ReleasedVector rates(maps.right.cols());
  for (int k = 0; k < rates.size(); ++k) {
    const Vector6 column = at_frame(maps.right.col(k));
    rates[k] = column.dot(at_frame(relative)) / column.squaredNorm();
  }
  if (remainder) *remainder = relative - maps.right * rates;
  return rates;
}

}  // namespace flexarm
