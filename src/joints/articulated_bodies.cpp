#include "joints/articulated_bodies.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "math/simd.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// The rotation by an angle about a unit vector.
Matrix3 turned(const Vector3& axis, double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  return c * Matrix3::Identity() + (1 - c) * axis * axis.transpose() + s * so3::hat(axis);
}

/// Calls work(N) with the number of a joint's rates as a constant.
template <class Work>
void with_count(int count, const Work& work) {
  switch (count) {
    case 1:
      return work(std::integral_constant<int, 1>());
    case 3:
      return work(std::integral_constant<int, 3>());
    case 6:
      return work(std::integral_constant<int, 6>());
    default:
      return;
  }
}

template <int Count>
Eigen::Matrix<double, Count, Count> inverse(const Eigen::Matrix<double, Count, Count>& matrix) {
  if constexpr (Count < 4) return matrix.inverse();
  return Eigen::LLT<Eigen::Matrix<double, Count, Count>>(matrix).solve(Eigen::Matrix<double, Count, Count>::Identity());
}

}  // namespace

ArticulatedBodies::ArticulatedBodies(const Model& model) : bodies_(model.nodes.size()), gravity_(model.gravity) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].mass = model.inertias[i].mass;
    bodies_[i].rotary = model.inertias[i].rotary;
  }
  for (const JointMap& joint : model.joints) {
    assert(joint.kind != JointMapKind::Slide);
    Link& link = links_.emplace_back();
    link.kind = joint.kind;
    link.master = joint.master, link.slave = joint.slave;
    link.first = rate_count_, link.count = released_count(joint.kind);
    rate_count_ += link.count;
    link.origin = joint.origin.position, link.frame = joint.origin.orientation.toRotationMatrix();
    link.translation = joint.translation, link.arm = joint.arm;
    link.turn = joint.rotation.norm();
    link.axis = link.turn > 0 ? Vector3(joint.rotation / link.turn) : Vector3::Zero();
    link.slave_frame = joint.slave_orientation.toRotationMatrix();
    link.profile = joint.profile.get();
    link.columns.setZero();
  }
}

void ArticulatedBodies::set(const std::vector<Released>& released, const double* rates) {
  simd::run([&] {
    for (std::size_t j = 0; j < links_.size(); ++j) move(links_[j], released[j], rates + links_[j].first);
  });
}

/// Places the slave of a joint, and sets what depends on configuration and rates alone.
void ArticulatedBodies::move(Link& link, const Released& released, const double* rates) {
  static const Body world = [] {
    Body body;
    body.rotation.setIdentity();
    body.position.setZero(), body.velocity.setZero();
    return body;
  }();
  const Body& master = link.master < 0 ? world : bodies_[link.master];
  Body& slave = bodies_[link.slave];
  const Vector3 spin = master.velocity.tail<3>();
  Vector3 from = link.origin, sliding = Vector3::Zero(), turning = Vector3::Zero(), bend = Vector3::Zero();
  Matrix3 turn = link.frame;  // of the moved joint frame in the master
  if (link.kind == JointMapKind::Scalar) {
    const double u = released.displacement[0], rate = rates[0];
    const double way = link.profile ? link.profile->value(u) : u,
                 slope = link.profile ? link.profile->derivative(u) : 1;
    from += way * link.translation;
    sliding = slope * rate * link.translation;
    if (link.profile) bend = link.profile->second_derivative(u) * rate * rate * link.translation;
    turning = rate * link.turn * link.axis;
    if (link.turn != 0) turn = turned(link.axis, link.turn * u);  // such joints have the frame of the master
    link.columns.col(0) << slope * link.translation, link.turn * link.axis;
  } else if (link.kind == JointMapKind::Free || link.kind == JointMapKind::Spherical) {
    const bool is_free = link.kind == JointMapKind::Free;
    if (is_free) {
      from += link.frame * released.displacement;
      sliding = link.frame * Eigen::Map<const Vector3>(rates);
      link.columns.leftCols<3>() << link.frame, Matrix3::Zero();
    }
    turning = link.frame * Eigen::Map<const Vector3>(rates + (is_free ? 3 : 0));
    link.columns.middleCols<3>(link.count - 3) << Matrix3::Zero(), link.frame;
    turn = link.frame * released.rotation.toRotationMatrix();
  }
  // All of this to world axes.
  const Matrix3& of_master = master.rotation;
  slave.rotation.noalias() = of_master * (turn * link.slave_frame);
  const Vector3 arm = slave.rotation * link.arm, to_joint = of_master * from;
  link.way = to_joint + arm;
  slave.position = master.position + link.way;
  sliding = of_master * sliding, turning = of_master * turning;
  const Vector3 slave_spin = spin + turning, spin_drift = spin.cross(turning);
  slave.velocity << master.velocity.head<3>() + spin.cross(to_joint) + sliding + slave_spin.cross(arm), slave_spin;
  link.drift << spin.cross(spin.cross(to_joint) + 2 * sliding) + of_master * bend +
                    slave_spin.cross(slave_spin.cross(arm)) + spin_drift.cross(arm),
      spin_drift;
  for (int k = 0; k < link.count; ++k) {
    const Vector3 axis = of_master * link.columns.col(k).tail<3>();
    link.columns.col(k) << of_master * link.columns.col(k).head<3>() + axis.cross(arm), axis;
  }
  const Matrix3 rotary = slave.rotation * slave.rotary * slave.rotation.transpose();
  slave.inertia.setZero();
  slave.inertia.diagonal().head<3>().setConstant(slave.mass);
  slave.inertia.bottomRightCorner<3, 3>() = rotary;
  slave.bias << -slave.mass * gravity_, slave_spin.cross(rotary * slave_spin);
}

void ArticulatedBodies::accelerate(const double* efforts, const double* armatures, double* rates_change) {
  simd::run([&] {
    for (std::size_t j = links_.size(); j-- > 0;) pass_on(links_[j], efforts, armatures);
    for (const Link& link : links_) follow(link, rates_change);
  });
}

/// Adds to the master what it feels of the slave: its articulated inertia without the joint's motions, and its bias.
void ArticulatedBodies::pass_on(Link& link, const double* efforts, const double* armatures) {
  const Body& slave = bodies_[link.slave];
  Matrix6 inertia = slave.inertia;
  Vector6 bias = slave.bias;
  with_count(link.count, [&](auto constant) {
    constexpr int kCount = constant;
    const Eigen::Matrix<double, 6, kCount> columns = link.columns.template leftCols<kCount>(),
                                           forces = inertia * columns;
    Eigen::Matrix<double, kCount, kCount> own = columns.transpose() * forces;
    own.diagonal() += Eigen::Map<const Eigen::Matrix<double, kCount, 1>>(armatures + link.first);
    const Eigen::Matrix<double, kCount, kCount> inverse = flexarm::inverse<kCount>(own);
    const Eigen::Matrix<double, kCount, 1> lack =
        Eigen::Map<const Eigen::Matrix<double, kCount, 1>>(efforts + link.first) - columns.transpose() * bias;
    const Eigen::Matrix<double, 6, kCount> held = forces * inverse;
    inertia -= held * forces.transpose();
    bias += held * lack;
    link.held.template leftCols<kCount>() = held;
    link.change.template head<kCount>() = inverse * lack;
  });
  if (link.master < 0) return;
  bias += inertia * link.drift;
  Body& master = bodies_[link.master];
  const Matrix3 way = so3::hat(link.way);
  const Matrix3 linear = inertia.topLeftCorner<3, 3>(), mixed = inertia.topRightCorner<3, 3>();
  const Matrix3 moved = mixed - linear * way;
  master.inertia.topLeftCorner<3, 3>() += linear;
  master.inertia.topRightCorner<3, 3>() += moved;
  master.inertia.bottomLeftCorner<3, 3>() += moved.transpose();
  master.inertia.bottomRightCorner<3, 3>() += inertia.bottomRightCorner<3, 3>() + way * moved - mixed.transpose() * way;
  master.bias.head<3>() += bias.head<3>();
  master.bias.tail<3>() += bias.tail<3>() + link.way.cross(Vector3(bias.head<3>()));
}

/// Finds the accelerations of a joint and its slave from that of the master.
void ArticulatedBodies::follow(const Link& link, double* rates_change) {
  Vector6& change = bodies_[link.slave].acceleration;
  change = link.drift;
  if (link.master >= 0) {
    const Vector6& of_master = bodies_[link.master].acceleration;
    change.head<3>() += of_master.head<3>() - link.way.cross(of_master.tail<3>());
    change.tail<3>() += of_master.tail<3>();
  }
  with_count(link.count, [&](auto constant) {
    constexpr int kCount = constant;
    const Eigen::Matrix<double, kCount, 1> rates =
        link.change.template head<kCount>() - link.held.template leftCols<kCount>().transpose() * change;
    Eigen::Map<Eigen::Matrix<double, kCount, 1>>(rates_change + link.first) = rates;
    change += link.columns.template leftCols<kCount>() * rates;
  });
}

}  // namespace flexarm
