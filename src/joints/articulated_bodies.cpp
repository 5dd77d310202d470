#include "joints/articulated_bodies.h"

#include <cassert>
#include <cmath>
#include <type_traits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "math/simd.h"

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

template <int Count>
Eigen::Matrix<double, Count, Count> inverse(const Eigen::Matrix<double, Count, Count>& matrix) {
  if constexpr (Count < 4) return matrix.inverse();
  return Eigen::LLT<Eigen::Matrix<double, Count, Count>>(matrix).solve(Eigen::Matrix<double, Count, Count>::Identity());
}

}  // namespace

ArticulatedBodies::ArticulatedBodies(const Model& model)
    : bodies_(model.nodes.size()), carriers_(bodies_.size(), -1), forces_(bodies_.size()), gravity_(model.gravity) {
  world_.rotation = PaddedMatrix3::diagonal(1);
  world_.position = Padded3::zero(), world_.velocity = PaddedSpatial::zero();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].mass = model.inertias[i].mass;
    bodies_[i].rotary = PaddedMatrix3(model.inertias[i].rotary);
  }
  for (const JointMap& joint : model.joints) {
    assert(joint.kind != JointMapKind::Slide);
    Link& link = links_.emplace_back();
    link.kind = joint.kind;
    link.master = joint.master, link.slave = joint.slave;
    carriers_[link.slave] = static_cast<int>(links_.size()) - 1;
    link.first = rate_count_, link.count = released_count(joint.kind);
    rate_count_ += link.count;
    link.origin = Padded3(joint.origin.position);
    link.frame = PaddedMatrix3(joint.origin.orientation.toRotationMatrix());
    link.translation = Padded3(joint.translation), link.arm = Padded3(joint.arm);
    link.turn = joint.rotation.norm();
    link.rotation = Padded3(joint.rotation);
    link.slave_frame = PaddedMatrix3(joint.slave_orientation.toRotationMatrix());
    const Padded3 axis(link.turn > 0 ? Vector3(joint.rotation / link.turn) : Vector3::Zero());
    link.turned_once = cross(axis, link.slave_frame), link.turned_twice = cross(axis, link.turned_once);
    link.travels = !joint.translation.isZero(0);
    link.profile = joint.profile.get();
  }
}

void ArticulatedBodies::set(const std::vector<Released>& released, const double* rates) {
  simd::run([&] {
    for (std::size_t j = 0; j < links_.size(); ++j) move(links_[j], released[j], rates + links_[j].first);
  });
}

/// The motion of a joint with one coordinate, world axes.
void ArticulatedBodies::move_scalar(Link& link, double u, double rate, const PaddedMatrix3& master, Motion& out) {
  Padded3 axis = Padded3::zero(), travel = Padded3::zero();
  out.to_joint = master * link.origin;
  if (link.turn != 0) {
    axis = master * link.rotation;
    const double angle = link.turn * u;
    out.rotation =
        master * (link.slave_frame + std::sin(angle) * link.turned_once + (1 - std::cos(angle)) * link.turned_twice);
    out.turning = rate * axis;
  } else {
    out.rotation = master * link.slave_frame;
    out.turning = Padded3::zero();
  }
  out.sliding = out.bend = Padded3::zero();
  if (link.travels) {
    const CamProfile* profile = link.profile;
    travel = master * link.translation;
    out.to_joint += (profile ? profile->value(u) : u) * travel;
    if (profile) {
      out.bend = profile->second_derivative(u) * rate * rate * travel;
      travel = profile->derivative(u) * travel;
    }
    out.sliding = rate * travel;
  }
  out.arm = out.rotation * link.arm;
  link.columns[0] = {travel + cross(axis, out.arm), axis};
}

/// The motion of a joint with none or several coordinates, world axes.
void ArticulatedBodies::move_frame(Link& link, const Released& released, const double* rates,
                                   const PaddedMatrix3& master, Motion& out) {
  const PaddedMatrix3 frame = master * link.frame;
  out.to_joint = master * link.origin;
  out.sliding = out.turning = out.bend = Padded3::zero();
  const bool turns = link.count >= 3;
  out.rotation =
      frame * (turns ? PaddedMatrix3(released.rotation.toRotationMatrix()) * link.slave_frame : link.slave_frame);
  out.arm = out.rotation * link.arm;
  if (link.count == 6) {
    out.to_joint += frame * Padded3(Vector3(released.displacement));
    out.sliding = frame * Padded3(Vector3(Eigen::Map<const Vector3>(rates)));
    for (int k = 0; k < 3; ++k) link.columns[k] = {frame.columns[k], Padded3::zero()};
  }
  if (!turns) return;
  const int first = link.count - 3;  // of the rates that turn
  out.turning = frame * Padded3(Vector3(Eigen::Map<const Vector3>(rates + first)));
  for (int k = 0; k < 3; ++k) link.columns[first + k] = {cross(frame.columns[k], out.arm), frame.columns[k]};
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
  const Padded3 spin = master.velocity.angular, slave_spin = spin + turning, spin_drift = cross(spin, turning);
  const Padded3 carried = cross(spin, to_joint), swung = cross(slave_spin, arm);
  slave.velocity = {master.velocity.linear + carried + sliding + swung, slave_spin};
  link.drift = {cross(spin, carried + 2 * sliding) + bend + cross(slave_spin, swung) + cross(spin_drift, arm),
                spin_drift};
  const PaddedMatrix3 rotary = times_transposed(rotation * slave.rotary, rotation), none = PaddedMatrix3::diagonal(0);
  slave.inertia = {PaddedMatrix3::diagonal(slave.mass), none, none, rotary};
  slave.bias = {-slave.mass * gravity_, cross(slave_spin, rotary * slave_spin)};
}

void ArticulatedBodies::accelerate(const double* efforts, const double* armatures, double* rates_change) {
  simd::run([&] {
    for (std::size_t j = links_.size(); j-- > 0;) pass_on(links_[j], efforts, armatures);
    for (const Link& link : links_) follow(link, rates_change);
  });
}

/// Takes the motions of the joint out of the inertia and the bias of its slave: what remains is felt by the master.
template <int Count>
void ArticulatedBodies::release(Link& link, const double* efforts, const double* armatures, PaddedInertia& inertia,
                                PaddedSpatial& bias) {
  PaddedSpatial forces[Count];
  Eigen::Matrix<double, Count, Count> own;
  Eigen::Matrix<double, Count, 1> lack;
  for (int k = 0; k < Count; ++k) {
    forces[k] = inertia * link.columns[k];
    for (int l = 0; l <= k; ++l) own(l, k) = own(k, l) = dot(link.columns[l], forces[k]);
    own(k, k) += armatures[k];
    lack[k] = efforts[k] - dot(link.columns[k], bias);
  }
  const Eigen::Matrix<double, Count, Count> inverse = flexarm::inverse<Count>(own);
  Eigen::Map<Eigen::Matrix<double, Count, 1>>(link.change) = inverse * lack;
  for (int k = 0; k < Count; ++k) {
    PaddedSpatial held = inverse(0, k) * forces[0];
    for (int l = 1; l < Count; ++l) held += inverse(l, k) * forces[l];
    inertia.subtract_outer(held, forces[k]);
    bias += lack[k] * held;
    link.held[k] = held;
  }
}

/// Adds to the master what it feels of the slave: its articulated inertia without the joint's motions, and its bias.
void ArticulatedBodies::pass_on(Link& link, const double* efforts, const double* armatures) {
  const Body& slave = bodies_[link.slave];
  PaddedInertia inertia = slave.inertia;
  PaddedSpatial bias = slave.bias;
  with_count(link.count, [&](auto count) {
    release<decltype(count)::value>(link, efforts + link.first, armatures + link.first, inertia, bias);
  });
  if (link.master < 0) return;
  bias += inertia * link.drift;
  Body& master = bodies_[link.master];
  master.inertia += inertia.moved(link.way);
  master.bias += moved_force(bias, link.way);
}

PaddedSpatial ArticulatedBodies::carried_acceleration(const Link& link) const {
  if (link.master < 0) return link.drift;
  const PaddedSpatial& of_master = bodies_[link.master].acceleration;
  return link.drift + PaddedSpatial(of_master.linear - cross(link.way, of_master.angular), of_master.angular);
}

/// Finds the accelerations of a joint and its slave from that of the master.
void ArticulatedBodies::follow(const Link& link, double* rates_change) {
  const PaddedSpatial carried = carried_acceleration(link);
  PaddedSpatial change = carried;
  for (int k = 0; k < link.count; ++k) {
    const double rate = link.change[k] - dot(link.held[k], carried);
    rates_change[link.first + k] = rate;
    change += rate * link.columns[k];
  }
  bodies_[link.slave].acceleration = change;
}

// ---------------------------------------------------------------- rates that depend on each other

void ArticulatedBodies::set_accelerations(const double* rates_change) {
  for (const Link& link : links_) {
    PaddedSpatial change = carried_acceleration(link);
    for (int k = 0; k < link.count; ++k) change += rates_change[link.first + k] * link.columns[k];
    bodies_[link.slave].acceleration = change;
  }
}

void ArticulatedBodies::find_needed_efforts(const double* rates_change, const double* armatures, double* efforts) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    forces_[i] = bodies_[i].inertia * bodies_[i].acceleration + bodies_[i].bias;
  for (std::size_t j = links_.size(); j-- > 0;) {
    const Link& link = links_[j];
    const PaddedSpatial& force = forces_[link.slave];
    for (int k = link.first; k < link.first + link.count; ++k)
      efforts[k] = dot(link.columns[k - link.first], force) + armatures[k] * rates_change[k];
    if (link.master < 0) continue;
    forces_[link.master] += moved_force(force, link.way);
  }
}

void ArticulatedBodies::add_power(int node, const Vector6& force, double* row) const {
  add_power(node, PaddedSpatial(force), row);
}

void ArticulatedBodies::add_power(int node, PaddedSpatial force, double* row) const {
  while (node >= 0) {
    const Link& link = links_[carriers_[node]];
    for (int k = 0; k < link.count; ++k) row[link.first + k] += dot(link.columns[k], force);
    force = moved_force(force, link.way);
    node = link.master;
  }
}

void ArticulatedBodies::find_mass_matrix(const double* armatures, Eigen::MatrixXd& mass) {
  mass.setZero();
  for (std::size_t j = links_.size(); j-- > 0;) {
    const Link& link = links_[j];
    const PaddedInertia& inertia = bodies_[link.slave].inertia;  // of all that the joint carries
    for (int k = 0; k < link.count; ++k) {
      const int column = link.first + k;
      // Joints in the branch of this one, up to the root. Their rows are zero so far.
      add_power(link.slave, inertia * link.columns[k], mass.col(column).data());
      mass(column, column) += armatures[column];
      for (int row = 0; row < link.first; ++row) mass(column, row) = mass(row, column);
    }
    if (link.master >= 0) bodies_[link.master].inertia += inertia.moved(link.way);
  }
}

}  // namespace flexarm
