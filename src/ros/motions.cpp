#include "motions.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "control_types.h"
#include "stepping/command_reader.h"

namespace flexarm::node {
namespace {

using Result = control::FollowJointTrajectoryResult;

}  // namespace

Motions::Motions(const Simulation& shown, SteppingThread& stepping, Context context)
    : shown_(shown),
      stepping_(stepping),
      context_(std::move(context)),
      followed_(shown.coordinate_names().size()),
      limit_watch_(shown) {}

template <class Change>
void Motions::change(const Change& change) {
  stepping_.between_steps([&](Simulation& simulation) {
    change(simulation);
    stepping_.trajectories().forget_before(reported_);  // reports of later steps may still be waiting
    adopt_scene();
  });
}

void Motions::adopt_scene() {
  followed_ = stepping_.trajectories();
  grips_ = stepping_.grips();
}

std::vector<std::string> Motions::names_of(const std::vector<std::size_t>& joints) const {
  std::vector<std::string> names;
  for (const std::size_t joint : joints) names.push_back(shown_.coordinate_names()[joint]);
  return names;
}

Motions::Fault Motions::follow(const trajectory_msgs::JointTrajectory& message, const std::vector<std::string>& group,
                               std::vector<std::size_t>& joints) {
  if (const std::string refusal = context_.refusal(); !refusal.empty()) return {Result::INVALID_GOAL, refusal};
  const auto is_of_group = [&group](const std::string& name) {
    return group.empty() || std::find(group.begin(), group.end(), name) != group.end();
  };
  for (const std::string& name : message.joint_names)
    if (!is_of_group(name))
      return {Result::INVALID_JOINTS,
              fmt::format("'{}' is not a joint of this controller, which has {}", name, fmt::join(group, ", "))};
  if (!message.points.empty()) return follow_points(message, joints);
  for (std::size_t joint = 0; joint < followed_.joint_count(); ++joint)
    if (followed_.follows(joint) && is_of_group(shown_.coordinate_names()[joint])) joints.push_back(joint);
  stop(joints);
  return {};
}

Motions::Fault Motions::follow_points(const trajectory_msgs::JointTrajectory& message,
                                      std::vector<std::size_t>& joints) {
  if (const std::string fault = read_trajectory_joints(shown_, message.joint_names, joints); !fault.empty())
    return {Result::INVALID_JOINTS, fault};
  JointTrajectory trajectory = trajectory_of(message, joints);
  if (const std::string fault = followed_.find_fault(trajectory); !fault.empty()) return {Result::INVALID_GOAL, fault};
  Fault fault;
  change([&](const Simulation& simulation) {
    const double now = stepping_.time();
    trajectory.start = message.header.stamp.isZero() ? now : context_.time_of(message.header.stamp);
    if (TrajectoryFollower::is_over(trajectory, now)) {
      const double since = now - trajectory.start - trajectory.points.back().time;
      fault = {Result::OLD_HEADER_TIMESTAMP, fmt::format("its last point was {:.3g} s ago", since)};
      return;
    }
    std::vector<double> set_points;
    for (const std::size_t joint : joints) {
      set_points.push_back(simulation.set_point(joint));
      stepping_.grips().release(joint);
    }
    stepping_.trajectories().follow(trajectory, now, set_points);
  });
  if (fault.is_none()) limit_watch_.look(trajectory);
  return fault;
}

std::string Motions::grip(const std::vector<Target>& targets, double max_effort) {
  std::vector<std::size_t> joints, same;
  for (const Target& target : targets) joints.push_back(target.joint);
  std::string fault = read_trajectory_joints(shown_, names_of(joints), same);
  for (const std::size_t joint : joints)
    if (fault.empty() && max_effort > 0) fault = Grips::refusal_of_limit(shown_, joint);
  if (!fault.empty()) return fault;
  change([&](Simulation&) {
    for (const Target& target : targets) {
      stepping_.trajectories().release(target.joint);
      stepping_.grips().close(target.joint, target.position, max_effort);
    }
  });
  for (const Target& target : targets) limit_watch_.look(target.joint, target.position);
  return {};
}

void Motions::stop(const std::vector<std::size_t>& joints) {
  change([&](Simulation&) {
    TrajectoryFollower& follower = stepping_.trajectories();
    for (const std::size_t joint : joints)
      if (follower.follows(joint)) follower.stop(joint, stepping_.time(), context_.stop_duration);
  });
}

void Motions::release_arrived(double now) {
  reported_ = now;
  followed_.release_arrived(now);
}

void Motions::release(std::size_t joint) {
  if (!followed_.follows(joint) && !grips_.holds(joint)) return;
  change([&](Simulation&) {
    stepping_.trajectories().release(joint);
    stepping_.grips().release(joint);
  });
}

void Motions::release_all() {
  change([&](Simulation&) {
    TrajectoryFollower& follower = stepping_.trajectories();
    for (std::size_t joint = 0; joint < follower.joint_count(); ++joint) follower.release(joint);
    stepping_.grips().release_all();
  });
}

}  // namespace flexarm::node
