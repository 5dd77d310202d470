#include "contact/contact_element.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "joints/penetration.h"
#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {
namespace {

using so3::hat;

/// Freedoms of the most nodes that an element may have.
constexpr int kMostColumns = 6 * (ContactStation::kMostNodes + 1);
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostColumns>;

/// Ways that a step may come to beyond those at the speed of its beginning: times that, and of the size.
constexpr double kMoreWay = 2, kNear = 0.02;
/// So deep, of the depth, a corner may be in a shape without having come in by a face.
constexpr double kUnseen = 0.01;
/// Cosine of normals at both ends of a step that goes to the other side of something thin.
constexpr double kOtherSide = -0.5;

std::vector<int> reach_of(const ContactStations& side, const ContactSurface& surface) {
  std::vector<int> nodes;
  if (side.nodes[0] >= 0) nodes = side.nodes;
  if (surface.node >= 0) nodes.push_back(surface.node);
  return nodes;
}

PointMemory memory_at(const double* numbers) {
  return {numbers[0], Eigen::Map<const Vector3>(numbers + 1), static_cast<int>(numbers[4]), numbers[5]};
}

auto poses_in(const std::vector<NodePose>& nodes) {
  return [&nodes](int node) { return node < 0 ? NodePose() : nodes[node]; };
}

auto poses_in(const State& state) {
  return [&state](int node) { return node < 0 ? NodePose() : node_pose(state.nodes[node]); };
}

}  // namespace

ContactElement::ContactElement(std::vector<std::string> links, ContactStations side, ContactSurface surface,
                               const ContactLaw& law)
    : ForceElement("", reach_of(side, surface)),
      links_(std::move(links)),
      side_(std::move(side)),
      surface_(std::move(surface)),
      law_(law) {
  assert(!side_.nodes.empty() && side_.nodes.size() <= ContactStation::kMostNodes);
  for (const ContactStation& station : side_.stations) size_ = std::max(size_, station.arm.norm() + station.radius);
}

std::string ContactElement::description() const {
  return fmt::format("{} points, {:.4g} N/m each, friction {:g}", side_.stations.size() * surface_.shapes.size(),
                     law_.stiffness, law_.friction);
}

int ContactElement::memory_size() const {
  return PointMemory::kSize * static_cast<int>(side_.stations.size() * surface_.shapes.size());
}

ContactLaw ContactElement::law_of(const ContactStation& station) const {
  ContactLaw law = law_;
  law.stiffness *= station.share;
  law.grip *= station.share;
  return law;
}

template <class Visit>
void ContactElement::for_each_pair(const Visit& visit) const {
  for (const ContactStation& station : side_.stations)
    for (const ContactShape& shape : surface_.shapes)
      if (!visit(station, shape)) return;
}

// ---------------------------------------------------------------- where

Vector3 ContactElement::velocity(const ContactStation& station, const std::vector<NodePose>& poses,
                                 const std::vector<Vector6>& velocities) const {
  const auto motion_of = [&](int node) { return node < 0 ? Vector6(Vector6::Zero()) : velocities[node]; };
  const auto pose_of = poses_in(poses);
  Vector3 velocity = Vector3::Zero();
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) {
    const Vector6 motion = motion_of(side_.nodes[i]);
    const Vector3 arm = pose_of(side_.nodes[i]).rotation * station.arm;
    velocity += station.weights[i] * (motion.head<3>() + motion.tail<3>().cross(arm));
  }
  const NodePose base = pose_of(surface_.node);
  const Vector6 motion = motion_of(surface_.node);
  velocity -= motion.head<3>() + motion.tail<3>().cross(middle_of(side_, station, pose_of) - base.position);
  return base.rotation.transpose() * velocity;
}

int ContactElement::find_nodes(const ForceStart& start, int* nodes) const {
  std::copy(reach().begin(), reach().end(), nodes);
  const int all = static_cast<int>(reach().size());
  if (start.duration == 0) return all;
  bool is_near = false;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const double gap = shape.gap(place(station, poses_in(start.poses))) - station.radius;
    const double way = std::abs(start.duration) * velocity(station, start.poses, start.velocities).norm();
    is_near = gap < kMoreWay * way + kNear * size_;
    return !is_near;
  });
  return is_near ? all : 0;
}

bool ContactElement::needs_halves(const ForceStep& step, const int*, int count) const {
  if (step.duration == 0) return false;
  bool is_too_long = false;
  const double* memory = step.memory;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const Vector3 from = place(station, poses_in(step.begin)), to = place(station, poses_in(step.end));
    if (shape.gap(from) - station.radius > (to - from).norm()) {
      memory += PointMemory::kSize;
      return true;
    }
    PointMotion motion;
    motion.begin = from, motion.end = to;
    motion.outwards = outwards(station, poses_in(step.begin));
    const FeltShape felt = felt_shape(shape, law_, station.radius, motion, memory_at(memory));
    const SignedDistance begin = felt.shape.distance(from), end = felt.shape.distance(to);
    const double begin_rate = -begin.gradient.dot(velocity(station, step.begin, step.velocities));
    ContactChange change{felt.radius - begin.value, felt.radius - end.value, std::abs(step.duration)};
    change.speed = approach_speed(change.begin, begin_rate, memory[0]);
    memory += PointMemory::kSize;
    if (!felt.is_felt) {  // of a corner that no face has seen coming in
      is_too_long = passes_through(shape, from, to, -kUnseen * law_.depth);
      return !is_too_long;
    }
    if (change.begin <= 0 && change.end <= 0)
      is_too_long = passes_through(felt.shape, from, to, felt.radius);
    else
      is_too_long = count == 0 || begin.gradient.dot(end.gradient) < kOtherSide ||
                    is_coarse_hit(law_, change, begin_rate, step.refinement);
    return !is_too_long;
  });
  return is_too_long;
}

// ---------------------------------------------------------------- what it does

/// Of both sides over a step; means where these count, else at the end.
struct ContactElement::Frames {
  double weight;  // of the end in means
  NodePose base_begin, base_end;
  Matrix3 axes;  // of the shapes
  std::array<Vector3, ContactStation::kMostNodes> turns;
  Vector3 base_turn = Vector3::Zero();
};

ContactElement::Frames ContactElement::frames(const ForceStep& step) const {
  Frames out;
  out.weight = step.at_end ? 1 : 0.5;
  out.base_begin = poses_in(step.begin)(surface_.node);
  out.base_end = poses_in(step.end)(surface_.node);
  out.axes = out.weight * out.base_end.rotation + (1 - out.weight) * out.base_begin.rotation;
  const auto turn_of = [&](int node) {
    return node < 0 ? Vector3(Vector3::Zero())
                    : cayley::increment(step.begin[node].orientation, step.end[node].orientation);
  };
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) out.turns[i] = turn_of(side_.nodes[i]);
  out.base_turn = turn_of(surface_.node);
  return out;
}

/// A station over a step, world axes.
struct ContactElement::Placed {
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // from its only node
  Vector3 base_arm, end_base_arm;                            // from the shapes' node
  Vector3 turn;                                              // less that of the shapes
};

ContactElement::Placed ContactElement::placed(const ContactStation& station, const Frames& frames,
                                              const ForceStep& step) const {
  Placed out;
  const auto begin_of = poses_in(step.begin), end_of = poses_in(step.end);
  const double weight = frames.weight;
  const Vector3 begin = middle_of(side_, station, begin_of) - frames.base_begin.position;
  out.end_base_arm = middle_of(side_, station, end_of) - frames.base_end.position;
  out.base_arm = weight * out.end_base_arm + (1 - weight) * begin;
  out.turn = -frames.base_turn;
  for (std::size_t i = 0; i < side_.nodes.size(); ++i) out.turn += station.weights[i] * frames.turns[i];
  if (side_.nodes.size() > 1) return out;
  out.end_arm = end_of(side_.nodes[0]).rotation * station.arm;
  out.arm = weight * out.end_arm + (1 - weight) * (begin_of(side_.nodes[0]).rotation * station.arm);
  return out;
}

void ContactElement::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  std::fill(step.new_memory, step.new_memory + memory_size(), 0.0);
  action.residual.setZero();
  action.tangent.setZero();
  if (action.residual.size() == 0) {  // nothing is near
    action.dissipated = remembered_energy(step);
    return;
  }
  const Frames frames = this->frames(step);
  const double* memory = step.memory;
  double* new_memory = step.new_memory;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const bool is_new = std::all_of(memory, memory + PointMemory::kSize, [](double number) { return number == 0; });
    PointMotion motion;
    motion.begin = place(station, poses_in(step.begin));
    motion.end = place(station, poses_in(step.end));
    // No surface is nearer than the distance.
    if (is_new && shape.gap(motion.begin) - station.radius > (motion.end - motion.begin).norm()) {
      memory += PointMemory::kSize;
      new_memory += PointMemory::kSize;
      return true;
    }
    const Placed placed = this->placed(station, frames, step);
    motion.turn = frames.axes.transpose() * placed.turn;
    if (step.duration != 0) motion.begin_velocity = velocity(station, step.begin, step.velocities);
    motion.duration = step.duration;
    motion.at_end = step.at_end;
    motion.outwards = outwards(station, poses_in(step.begin));
    const PointAction local =
        point_action(shape, law_of(station), station.radius, motion, memory_at(memory), action.tangent.size() > 0);
    action.dissipated += local.dissipated;
    new_memory[0] = local.memory.speed;
    Eigen::Map<Vector3>(new_memory + 1) = local.memory.stretch;
    new_memory[4] = local.memory.face;
    new_memory[5] = local.memory.within;
    memory += PointMemory::kSize;
    new_memory += PointMemory::kSize;
    if (local.acts) add(station, frames, placed, local, action);
    if (local.acts && action.tangent.size() > 0) add_tangent(station, frames, placed, local, action);
    return true;
  });
}

/// Of what is remembered at the beginning of a step, and not felt any more [J].
double ContactElement::remembered_energy(const ForceStep& step) const {
  double energy = 0;
  const double* memory = step.memory;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const PointMemory old = memory_at(memory);
    if (old.face != 0 || old.stretch != Vector3::Zero())
      energy += stored_energy(shape, law_of(station), station.radius, place(station, poses_in(step.begin)), old);
    memory += PointMemory::kSize;
    return true;
  });
  return energy;
}

void ContactElement::add(const ContactStation& station, const Frames& frames, const Placed& placed,
                         const PointAction& local, ForceAction& action) const {
  const Vector3 force = frames.axes * local.wrench.head<3>(), couple = frames.axes * local.wrench.tail<3>();
  Vector6 wrench;
  wrench << force, placed.arm.cross(force) + couple;
  const int count = moving_nodes();
  for (int i = 0; i < count; ++i) action.residual.segment<6>(6 * i) -= station.weights[i] * wrench;
  wrench << force, placed.base_arm.cross(force) + couple;
  if (surface_.node >= 0) action.residual.segment<6>(6 * count) += wrench;
}

void ContactElement::add_tangent(const ContactStation& station, const Frames& frames, const Placed& placed,
                                 const PointAction& local, ForceAction& action) const {
  const int count = moving_nodes(), base = 6 * count;
  const bool is_body = count == 1, has_base = surface_.node >= 0;
  const Matrix3& end_axes = frames.base_end.rotation;
  // Of the place at the end, of it in the shapes' frame, and of the turn there, by {displacement, spin} of all.
  Rows3 way = Rows3::Zero(3, base + 6 * has_base), turn = way;
  for (int i = 0; i < count; ++i) {
    way.middleCols<3>(6 * i).diagonal().setConstant(station.weights[i]);
    turn.middleCols<3>(6 * i + 3) = station.weights[i] * cayley::inverse_tangent(frames.turns[i]);
  }
  if (is_body) way.middleCols<3>(3) = -hat(placed.end_arm);
  if (has_base) {
    way.middleCols<3>(base).diagonal().setConstant(-1);
    turn.middleCols<3>(base + 3) = -cayley::inverse_tangent(frames.base_turn);
  }
  Rows3 seen = end_axes.transpose() * way, turned = frames.axes.transpose() * turn;
  if (has_base) {
    seen.middleCols<3>(base + 3) = end_axes.transpose() * hat(placed.end_base_arm);
    turned.middleCols<3>(base + 3) += frames.weight * end_axes.transpose() * hat(placed.turn);
  }
  const Matrix6& slope = local.slope;
  Rows3 force = frames.axes * (slope.topLeftCorner<3, 3>() * seen + slope.topRightCorner<3, 3>() * turned);
  Rows3 couple = frames.axes * (slope.bottomLeftCorner<3, 3>() * seen + slope.bottomRightCorner<3, 3>() * turned);
  if (has_base) {
    force.middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.head<3>()));
    couple.middleCols<3>(base + 3) -= frames.weight * hat(Vector3(end_axes * local.wrench.tail<3>()));
  }
  const Matrix3 pressed = frames.weight * hat(Vector3(frames.axes * local.wrench.head<3>()));
  Rows3 moment = hat(placed.arm) * force + couple;
  if (is_body) moment.middleCols<3>(3) += pressed * hat(placed.end_arm);
  for (int i = 0; i < count; ++i) {
    action.tangent.middleRows<3>(6 * i) -= station.weights[i] * force;
    action.tangent.middleRows<3>(6 * i + 3) -= station.weights[i] * moment;
  }
  if (!has_base) return;
  action.tangent.middleRows<3>(base) += force;
  action.tangent.middleRows<3>(base + 3) += hat(placed.base_arm) * force - pressed * way + couple;
}

// ---------------------------------------------------------------- energies, small motions

double ContactElement::energy(const State& state, const double* memory) const {
  double energy = 0;
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const ContactLaw law = law_of(station);
    energy += stored_energy(shape, law, station.radius, place(station, poses_in(state)), memory_at(memory));
    memory += PointMemory::kSize;
    return true;
  });
  return energy;
}

template <class Visit>
void ContactElement::for_each_touching(const State& state, const Visit& visit) const {
  for_each_pair([&](const ContactStation& station, const ContactShape& shape) {
    const SignedDistance distance = shape.distance(place(station, poses_in(state)));
    if (distance.value < station.radius) visit(station, distance);
    return true;
  });
}

ForceMeasures ContactElement::measures(const State& state, const int*) const {
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::Index count = 0;
  for_each_touching(state, [&](const ContactStation&, const SignedDistance&) { count += each; });
  const Eigen::Index columns = 6 * static_cast<Eigen::Index>(reach().size());
  ForceMeasures out{Eigen::MatrixXd::Zero(count, columns), Eigen::MatrixXd::Zero(count, count)};
  const NodePose base = poses_in(state)(surface_.node);
  Eigen::Index row = 0;
  for_each_touching(state, [&](const ContactStation& station, const SignedDistance& distance) {
    const ContactLaw law = law_of(station);
    const Vector3 normal = base.rotation * distance.gradient;
    const Vector3 place = base.rotation * this->place(station, poses_in(state));  // from the shapes' node
    const Vector3 across = normal.unitOrthogonal();
    const Vector3 axes[] = {normal, across, normal.cross(across)};
    for (int k = 0; k < each; ++k) {
      // Sticking holds the surfaces, a radius below the station's middle.
      const Vector3 offset = k == 0 ? Vector3(Vector3::Zero()) : Vector3(-station.radius * normal);
      for (int i = 0; i < moving_nodes(); ++i) {
        const Matrix3 axes_of_node = poses_in(state)(side_.nodes[i]).rotation;
        const Vector3 arm = axes_of_node * station.arm + offset;
        out.rows.block<1, 6>(row, 6 * i) << station.weights[i] * axes[k].transpose(),
            station.weights[i] * arm.cross(axes[k]).transpose();
      }
      if (surface_.node >= 0)
        out.rows.block<1, 6>(row, columns - 6) << -axes[k].transpose(), -(place + offset).cross(axes[k]).transpose();
      out.stiffness(row, row) = k == 0 ? contact_push(law, {0, station.radius - distance.value, 0}).slope : law.grip;
      ++row;
    }
  });
  return out;
}

DamperTensions ContactElement::dampers(const State& state, const Eigen::VectorXd& rates) const {
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(rates.size());
  Eigen::Index row = 0;
  for_each_touching(state, [&](const ContactStation& station, const SignedDistance& distance) {
    // Of what is pressed slowly, see contact_push().
    const double slope = hardened({station.radius - distance.value, law_.depth}).slope;
    slopes[row] = 2 * law_of(station).stiffness * law_.damping / law_.frequency * slope;
    row += each;
  });
  assert(row == rates.size());
  return {slopes.cwiseProduct(rates), slopes.asDiagonal()};
}

}  // namespace flexarm
