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

/// matrix hat(v), without the products with zeros.
template <class Matrix>
Matrix3 times_hat(const Matrix& matrix, const Vector3& v) {
  Matrix3 out;
  out.col(0) = v[2] * matrix.col(1) - v[1] * matrix.col(2);
  out.col(1) = v[0] * matrix.col(2) - v[2] * matrix.col(0);
  out.col(2) = v[1] * matrix.col(0) - v[0] * matrix.col(1);
  return out;
}

template <int Count>
Eigen::Matrix<double, Count, Count> inverse(const Eigen::Matrix<double, Count, Count>& matrix) {
  if constexpr (Count < 4) return matrix.inverse();
  return Eigen::LLT<Eigen::Matrix<double, Count, Count>>(matrix).solve(Eigen::Matrix<double, Count, Count>::Identity());
}

}  // namespace

ArticulatedBodies::ArticulatedBodies(const Model& model)
    : bodies_(model.nodes.size()), carriers_(bodies_.size(), -1), forces_(bodies_.size()), gravity_(model.gravity) {
  world_.rotation.setIdentity();
  world_.position.setZero(), world_.velocity.setZero();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].mass = model.inertias[i].mass;
    bodies_[i].rotary = model.inertias[i].rotary;
  }
  for (const JointMap& joint : model.joints) {
    assert(joint.kind != JointMapKind::Slide);
    Link& link = links_.emplace_back();
    link.kind = joint.kind;
    link.master = joint.master, link.slave = joint.slave;
    carriers_[link.slave] = static_cast<int>(links_.size()) - 1;
    link.first = rate_count_, link.count = released_count(joint.kind);
    rate_count_ += link.count;
    link.origin = joint.origin.position, link.frame = joint.origin.orientation.toRotationMatrix();
    link.translation = joint.translation, link.arm = joint.arm;
    link.turn = joint.rotation.norm();
    link.rotation = joint.rotation;
    link.slave_frame = joint.slave_orientation.toRotationMatrix();
    const Matrix3 axis = so3::hat(link.turn > 0 ? Vector3(joint.rotation / link.turn) : Vector3::Zero());
    link.turned_once = axis * link.slave_frame, link.turned_twice = axis * link.turned_once;
    link.travels = !joint.translation.isZero(0);
    link.profile = joint.profile.get();
    link.columns.setZero();
  }
}

void ArticulatedBodies::set(const std::vector<Released>& released, const double* rates) {
  simd::run([&] {
    for (std::size_t j = 0; j < links_.size(); ++j) move(links_[j], released[j], rates + links_[j].first);
  });
}

/// The motion of a joint with one coordinate, world axes.
void ArticulatedBodies::move_scalar(Link& link, double u, double rate, const Matrix3& master, Motion& out) {
  Vector3 axis = Vector3::Zero(), travel = Vector3::Zero();
  out.to_joint = master * link.origin;
  if (link.turn != 0) {
    axis = master * link.rotation;
    const double angle = link.turn * u;
    out.rotation.noalias() =
        master * (link.slave_frame + std::sin(angle) * link.turned_once + (1 - std::cos(angle)) * link.turned_twice);
    out.turning = rate * axis;
  } else {
    out.rotation.noalias() = master * link.slave_frame;
    out.turning.setZero();
  }
  out.sliding.setZero(), out.bend.setZero();
  if (link.travels) {
    const CamProfile* profile = link.profile;
    travel = master * link.translation;
    out.to_joint += (profile ? profile->value(u) : u) * travel;
    if (profile) {
      out.bend = profile->second_derivative(u) * rate * rate * travel;
      travel *= profile->derivative(u);
    }
    out.sliding = rate * travel;
  }
  out.arm = out.rotation * link.arm;
  link.columns.col(0) << travel + axis.cross(out.arm), axis;
}

/// The motion of a joint with none or several coordinates, world axes.
void ArticulatedBodies::move_frame(Link& link, const Released& released, const double* rates, const Matrix3& master,
                                   Motion& out) {
  const Matrix3 frame = master * link.frame;
  out.to_joint = master * link.origin;
  out.sliding.setZero(), out.turning.setZero(), out.bend.setZero();
  const bool turns = link.count >= 3;
  out.rotation = frame * (turns ? Matrix3(released.rotation.toRotationMatrix() * link.slave_frame) : link.slave_frame);
  out.arm = out.rotation * link.arm;
  if (link.count == 6) {
    out.to_joint += frame * released.displacement;
    out.sliding = frame * Eigen::Map<const Vector3>(rates);
    link.columns.leftCols<3>() << frame, Matrix3::Zero();
  }
  if (!turns) return;
  out.turning = frame * Eigen::Map<const Vector3>(rates + link.count - 3);
  link.columns.middleCols<3>(link.count - 3) << -so3::hat(out.arm) * frame, frame;
}

/// Places the slave of a joint, and sets what depends on configuration and rates alone.
void ArticulatedBodies::move(Link& link, const Released& released, const double* rates) {
  const Body& master = link.master < 0 ? world_ : bodies_[link.master];
  Body& slave = bodies_[link.slave];
  Motion motion;
  if (link.kind == JointMapKind::Scalar)
    move_scalar(link, released.displacement[0], rates[0], master.rotation, motion);
  else
    move_frame(link, released, rates, master.rotation, motion);
  const auto& [rotation, to_joint, arm, sliding, turning, bend] = motion;
  slave.rotation = rotation;
  link.way = to_joint + arm;
  slave.position = master.position + link.way;
  const Vector3 spin = master.velocity.tail<3>(), slave_spin = spin + turning, spin_drift = spin.cross(turning);
  const Vector3 carried = spin.cross(to_joint), swung = slave_spin.cross(arm);
  slave.velocity << master.velocity.head<3>() + carried + sliding + swung, slave_spin;
  link.drift << spin.cross(carried + 2 * sliding) + bend + slave_spin.cross(swung) + spin_drift.cross(arm), spin_drift;
  const Matrix3 rotary = rotation * slave.rotary * rotation.transpose();
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
  add_moved(inertia, link.way, master.inertia);
  master.bias.head<3>() += bias.head<3>();
  master.bias.tail<3>() += bias.tail<3>() + link.way.cross(Vector3(bias.head<3>()));
}

/// Adds to an inertia about one node that of a body about another node, which is `way` from there.
void ArticulatedBodies::add_moved(const Matrix6& inertia, const Vector3& way, Matrix6& to) {
  const Matrix3 linear = inertia.topLeftCorner<3, 3>(), mixed = inertia.topRightCorner<3, 3>();
  const Matrix3 moved = mixed - times_hat(linear, way);
  to.topLeftCorner<3, 3>() += linear;
  to.topRightCorner<3, 3>() += moved;
  to.bottomLeftCorner<3, 3>() += moved.transpose();
  // hat(way) moved = -(moved^T hat(way))^T
  to.bottomRightCorner<3, 3>() += inertia.bottomRightCorner<3, 3>() - times_hat(moved.transpose(), way).transpose() -
                                  times_hat(mixed.transpose(), way);
}

Vector6 ArticulatedBodies::carried_acceleration(const Link& link) const {
  Vector6 change = link.drift;
  if (link.master < 0) return change;
  const Vector6& of_master = bodies_[link.master].acceleration;
  change.head<3>() += of_master.head<3>() - link.way.cross(of_master.tail<3>());
  change.tail<3>() += of_master.tail<3>();
  return change;
}

/// Finds the accelerations of a joint and its slave from that of the master.
void ArticulatedBodies::follow(const Link& link, double* rates_change) {
  Vector6& change = bodies_[link.slave].acceleration;
  change = carried_acceleration(link);
  with_count(link.count, [&](auto constant) {
    constexpr int kCount = constant;
    const Eigen::Matrix<double, kCount, 1> rates =
        link.change.template head<kCount>() - link.held.template leftCols<kCount>().transpose() * change;
    Eigen::Map<Eigen::Matrix<double, kCount, 1>>(rates_change + link.first) = rates;
    change += link.columns.template leftCols<kCount>() * rates;
  });
}

// ---------------------------------------------------------------- rates that depend on each other

void ArticulatedBodies::set_accelerations(const double* rates_change) {
  for (const Link& link : links_) {
    Vector6& change = bodies_[link.slave].acceleration;
    change = carried_acceleration(link);
    for (int k = 0; k < link.count; ++k) change += rates_change[link.first + k] * link.columns.col(k);
  }
}

void ArticulatedBodies::find_needed_efforts(const double* rates_change, const double* armatures, double* efforts) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    forces_[i] = bodies_[i].inertia * bodies_[i].acceleration + bodies_[i].bias;
  for (std::size_t j = links_.size(); j-- > 0;) {
    const Link& link = links_[j];
    const Vector6& force = forces_[link.slave];
    for (int k = link.first; k < link.first + link.count; ++k)
      efforts[k] = link.columns.col(k - link.first).dot(force) + armatures[k] * rates_change[k];
    if (link.master < 0) continue;
    forces_[link.master].head<3>() += force.head<3>();
    forces_[link.master].tail<3>() += force.tail<3>() + link.way.cross(Vector3(force.head<3>()));
  }
}

void ArticulatedBodies::add_power(int node, Vector6 force, double* row) const {
  while (node >= 0) {
    const Link& link = links_[carriers_[node]];
    for (int k = 0; k < link.count; ++k) row[link.first + k] += link.columns.col(k).dot(force);
    force.tail<3>() += link.way.cross(Vector3(force.head<3>()));
    node = link.master;
  }
}

void ArticulatedBodies::find_mass_matrix(const double* armatures, Eigen::MatrixXd& mass) {
  mass.setZero();
  for (std::size_t j = links_.size(); j-- > 0;) {
    const Link& link = links_[j];
    const Matrix6& inertia = bodies_[link.slave].inertia;  // of all that the joint carries
    for (int k = 0; k < link.count; ++k) {
      const int column = link.first + k;
      // Joints in the branch of this one, up to the root. Their rows are zero so far.
      add_power(link.slave, inertia * link.columns.col(k), mass.col(column).data());
      mass(column, column) += armatures[column];
      for (int row = 0; row < link.first; ++row) mass(column, row) = mass(row, column);
    }
    if (link.master >= 0) add_moved(inertia, link.way, bodies_[link.master].inertia);
  }
}

}  // namespace flexarm
