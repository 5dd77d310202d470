// Decides in which steps a contact may act, and which steps are too long for it. (docs/notes/contact.md 5)
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact/contact_element.h"

namespace flexarm {
namespace {

/// How deep a corner may be in a shape without having entered by a face, relative to ContactLaw::depth.
constexpr double kUnseen = 0.01;

}  // namespace

template <class PoseOf>
ContactElement::Bounds ContactElement::bounds(const PoseOf& pose_of) const {
  const auto middle_of_node = [&](int node) {
    const NodePose pose = pose_of(node);
    return Vector3(pose.position + pose.rotation * middle_arm_);
  };
  Vector3 middle = Vector3::Zero();
  for (const int node : side_.nodes) middle += middle_of_node(node) / static_cast<double>(side_.nodes.size());
  double apart = 0;
  for (const int node : side_.nodes) apart = std::max(apart, (middle_of_node(node) - middle).norm());
  const NodePose& base = pose_of(surface_.node);
  return {base.rotation.transpose() * (middle - base.position), spread_ * apart + own_radius_};
}

double ContactElement::highest_speed(const ForceStart& start) const {
  const auto pose_of = poses_in(start.poses);
  const auto motion_of = [&](int node) { return node < 0 ? Vector6(Vector6::Zero()) : start.velocities[node]; };
  const Vector6 base = motion_of(surface_.node);
  const Vector3 origin = pose_of(surface_.node).position;
  double speed = 0;
  for (const int node : side_.nodes) {
    const Vector6 motion = motion_of(node);
    const Vector3 arm = pose_of(node).rotation * middle_arm_;
    const Vector3 base_arm = pose_of(node).position + arm - origin;
    const Vector3 relative =
        motion.head<3>() + motion.tail<3>().cross(arm) - base.head<3>() - base.tail<3>().cross(base_arm);
    speed = std::max(speed, relative.norm());
  }
  // Stations of a beam are on its line, so rotations of nodes do not move them.
  if (side_.nodes.size() > 1) return spread_ * speed;
  return speed + (motion_of(side_.nodes[0]) - base).tail<3>().norm() * own_radius_;
}

int ContactElement::find_nodes(const ForceStart& start, int* nodes) const {
  std::copy(reach().begin(), reach().end(), nodes);
  const int all = static_cast<int>(reach().size());
  if (start.duration == 0) return all;
  const auto pose_of = poses_in(start.poses);
  const double duration = std::abs(start.duration), close = kNear * size_;
  const Bounds bounds = this->bounds(poses_in(start.poses));
  const double most = kMoreWay * duration * highest_speed(start) + close + bounds.radius;
  std::optional<SeenStations> seen;
  std::optional<StationVelocities> velocities;
  for (const ContactShape& shape : surface_.shapes) {
    if (shape.gap(bounds.middle) >= most) continue;
    if (!seen) {
      seen.emplace(side_, surface_, pose_of);
      velocities.emplace(side_, surface_, pose_of, start.velocities);
    }
    for (const ContactStation& station : side_.stations) {
      const double gap = seen->least_gap(station, shape);
      double way = duration * velocities->at(station, {seen->middle(station)}).norm();
      if (station.half > 0) way += duration * velocities->rotation().norm() * station.half;
      if (gap < kMoreWay * way + close) return all;
    }
  }
  return 0;
}

ForceRoom ContactElement::room(const ForceStart& start) const {
  const Bounds bounds = this->bounds(poses_in(start.poses));
  double least = std::numeric_limits<double>::infinity();
  for (const ContactShape& shape : surface_.shapes) least = std::min(least, shape.gap(bounds.middle));
  const double size = least - bounds.radius - kNear * size_;
  // Both sides move. The distance between two nodes of the stations' side changes by the motions of both. The shapes
  // rotate about their node.
  const double arm = surface_.node < 0 ? 0.0 : bounds.middle.norm() + std::max(size, 0.0);
  return {size, 2 + 2 * spread_, spread_ * (middle_arm_.norm() + 2 * own_radius_ + bounds.radius + arm)};
}

template <class Visit>
void ContactElement::for_each_passage(const ForceStep& step, const Visit& visit) const {
  const Bounds begin = bounds(poses_in(step.begin)), end = bounds(poses_in(step.end));
  const double most = (end.middle - begin.middle).norm() + 2 * begin.radius + end.radius;
  const std::size_t shapes = surface_.shapes.size();
  std::optional<Seen> seen;
  for (std::size_t k = 0; k < shapes; ++k) {
    const ContactShape& shape = surface_.shapes[k];
    if (shape.gap(begin.middle) > most) continue;
    if (!seen) seen.emplace(this->seen(step));
    const double* memory = step.memory + PointMemory::kSize * k;
    for (const ContactStation& station : side_.stations) {
      if (may_touch(station, shape, *seen) && !visit(passage(station, shape, memory_at(memory), step, *seen), shape))
        return;
      memory += PointMemory::kSize * shapes;
    }
  }
}

ContactElement::Passage ContactElement::passage(const ContactStation& station, const ContactShape& shape,
                                                const PointMemory& memory, const ForceStep& step,
                                                const Seen& seen) const {
  PointMotion motion = motion_of(station, shape, memory.face, seen);
  motion.duration = std::abs(step.duration);
  const Vector3 from = motion.begin_point(), to = motion.end_point();
  Passage out{from, to, felt_shape(shape, law_, station.radius, motion, memory), {}, {}, {}, 0};
  const FeltShape& felt = out.felt;
  if (!felt.is_felt) return out;
  out.begin = felt.shape.distance(from);
  out.end = felt.shape.distance(to);
  out.begin_rate = let_out_rate(law_, felt.start) - out.begin.gradient.dot(motion.begin_velocity);
  const double end_start = let_out(law_, felt.start, step.duration);
  out.change = {felt.radius - felt.start - out.begin.value + motion.begin_excess,
                felt.radius - end_start - out.end.value + motion.end_excess, motion.duration};
  out.change.speed = approach_speed(out.change.begin, out.begin_rate, memory.speed);
  return out;
}

bool ContactElement::needs_halves(const ForceStep& step, const int*, int count) const {
  if (step.duration == 0) return false;
  bool found = false;
  for_each_passage(step, [&](const Passage& passage, const ContactShape& shape) {
    found = is_too_long(passage, shape, step, count > 0);
    return !found;
  });
  return found;
}

bool ContactElement::is_too_long(const Passage& passage, const ContactShape& shape, const ForceStep& step,
                                 bool acts) const {
  const FeltShape& felt = passage.felt;
  // A corner that has not entered by any face.
  if (!felt.is_felt) return passes_through(shape, passage.from, passage.to, -kUnseen * law_.depth);
  if (passage.change.begin <= 0 && passage.change.end <= 0)
    return passes_through(felt.shape, passage.from, passage.to, felt.radius - felt.start);
  return !acts || passage.begin.gradient.dot(passage.end.gradient) < kOtherSide ||
         is_coarse_hit(law_, passage.change, passage.begin_rate, step.refinement);
}

void ContactElement::put_penetrations(const ForceStep& step, const int*, int, const PenetrationTaker& take) const {
  if (step.duration == 0) return;
  for_each_passage(step, [&](const Passage& passage, const ContactShape&) {
    const ContactChange& change = passage.change;
    if (passage.felt.is_felt && (change.begin > 0 || change.end > 0))
      take(change.begin, change.end, passage.begin_rate);
    return true;
  });
}

}  // namespace flexarm
