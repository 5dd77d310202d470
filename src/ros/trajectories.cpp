#include "trajectories.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "stepping/command_reader.h"

namespace flexarm::node {
namespace {

using End = TrajectoryAction::End;

constexpr int kQueueSize = 10;
constexpr double kFeedbackPeriod = 0.05;  ///< simulated [s]

trajectory_msgs::JointTrajectoryPoint message_of(const std::vector<JointPoint>& points) {
  trajectory_msgs::JointTrajectoryPoint message;
  for (const JointPoint& point : points) {
    message.positions.push_back(point.position);
    message.velocities.push_back(point.velocity);
  }
  return message;
}

}  // namespace

Trajectories::Trajectories(ros::NodeHandle& node, const Simulation& shown, SteppingThread& stepping, Context context,
                           double stop_duration)
    : shown_(shown),
      stepping_(stepping),
      context_(std::move(context)),
      stop_duration_(stop_duration),
      followed_(shown.coordinate_names().size()),
      subscriber_(node.subscribe("joint_trajectory", kQueueSize, &Trajectories::receive, this,
                                 ros::TransportHints().tcpNoDelay())),
      action_(node, {[this](const FollowJointTrajectoryGoal& message) { return follow_goal(message); },
                     [this] { stop(goal_.joints); }}) {}

template <class Change>
void Trajectories::change(const Change& change) {
  stepping_.between_steps([&](Simulation& simulation) {
    change(stepping_.trajectories(), stepping_.time(), simulation);
    followed_ = stepping_.trajectories();
  });
}

void Trajectories::judge(double now) {
  followed_.release_arrived(now);
  if (!action_.is_underway()) return;
  using Verdict = TrajectoryGoal::Verdict;
  desired_.clear();
  actual_.clear();
  for (const std::size_t joint : goal_.joints) {
    desired_.push_back(followed_.at(joint, now));
    actual_.push_back({shown_.position(joint), shown_.velocity(joint)});
  }
  const TrajectoryGoal::Judgement judgement = goal_.judge(now, desired_, actual_);
  if (judgement.verdict == Verdict::Reached) return action_.end(End::Succeeded, Result::SUCCESSFUL, "");
  if (judgement.verdict == Verdict::Underway) return publish_feedback(now, desired_, actual_);
  const bool is_path = judgement.verdict == Verdict::OffPath;
  const std::string& name = shown_.coordinate_names()[goal_.joints[judgement.joint]];
  const std::string text = fmt::format("'{}' is {} by {:.3g} in {}, more than {:.3g}, at {:.3f} s", name,
                                       is_path ? "off its path" : "not at its goal", judgement.error,
                                       judgement.quantity, judgement.allowed, shown_.time());
  const std::vector<std::size_t> joints = goal_.joints;
  action_.end(End::Aborted, is_path ? Result::PATH_TOLERANCE_VIOLATED : Result::GOAL_TOLERANCE_VIOLATED, text);
  stop(joints);
}

void Trajectories::publish_feedback(double now, const std::vector<JointPoint>& desired,
                                    const std::vector<JointPoint>& actual) {
  if (now < next_feedback_) return;
  next_feedback_ = now + kFeedbackPeriod;
  FollowJointTrajectoryFeedback feedback;
  feedback.header.stamp = ros::Time::now();
  feedback.joint_names = names_of(goal_.joints);
  std::vector<JointPoint> error;
  for (std::size_t k = 0; k < desired.size(); ++k)
    error.push_back({desired[k].position - actual[k].position, desired[k].velocity - actual[k].velocity});
  feedback.desired = message_of(desired);
  feedback.actual = message_of(actual);
  feedback.error = message_of(error);
  action_.publish_feedback(feedback);
}

void Trajectories::receive(const trajectory_msgs::JointTrajectory& message) {
  std::vector<std::size_t> joints;
  const Fault fault = follow(message, joints);
  if (!fault.is_none()) return context_.warn(fault.text);
  if (!stepping_.command_step()) context_.warn("it is followed, but more steps wait already than can be taken");
  action_.end(End::Canceled, Result::SUCCESSFUL, "another trajectory has replaced it");
}

Trajectories::Result Trajectories::follow_goal(const FollowJointTrajectoryGoal& message) {
  TrajectoryGoal goal;
  const std::vector<std::string>& names = message.trajectory.joint_names;
  Fault fault{Result::INVALID_GOAL, fault_of_tolerances(message.path_tolerance, names)};
  if (fault.is_none()) fault.text = fault_of_tolerances(message.goal_tolerance, names);
  if (fault.is_none()) fault = follow(message.trajectory, goal.joints);
  Result result;
  result.error_code = fault.code;
  result.error_string = fault.text;
  if (!fault.is_none()) return result;
  const std::vector<std::string> joints = names_of(goal.joints);
  goal.path = tolerances_of(message.path_tolerance, joints);
  goal.at_end = tolerances_of(message.goal_tolerance, joints);
  for (const std::size_t joint : goal.joints) goal.end = std::max(goal.end, followed_.end(joint));
  goal.patience = std::max(message.goal_time_tolerance.toSec(), 0.0);
  goal_ = std::move(goal);
  next_feedback_ = 0;
  return result;
}

Trajectories::Fault Trajectories::follow(const trajectory_msgs::JointTrajectory& message,
                                         std::vector<std::size_t>& joints) {
  if (const std::string refusal = context_.refusal(); !refusal.empty()) return {Result::INVALID_GOAL, refusal};
  if (message.points.empty()) {
    joints = moving_joints();
    stop(joints);
    return {};
  }
  if (const std::string fault = read_trajectory_joints(shown_, message.joint_names, joints); !fault.empty())
    return {Result::INVALID_JOINTS, fault};
  JointTrajectory trajectory = trajectory_of(message, joints);
  if (const std::string fault = followed_.find_fault(trajectory); !fault.empty()) return {Result::INVALID_GOAL, fault};
  Fault fault;
  change([&](TrajectoryFollower& follower, double now, const Simulation& simulation) {
    trajectory.start = message.header.stamp.isZero() ? now : context_.time_of(message.header.stamp);
    if (TrajectoryFollower::is_over(trajectory, now)) {
      const double since = now - trajectory.start - trajectory.points.back().time;
      fault = {Result::OLD_HEADER_TIMESTAMP, fmt::format("its last point is past by {:.3g} s", since)};
      return;
    }
    std::vector<double> set_points;
    for (const std::size_t joint : joints) set_points.push_back(simulation.set_point(joint));
    follower.follow(trajectory, now, set_points);
  });
  return fault;
}

std::vector<std::string> Trajectories::names_of(const std::vector<std::size_t>& joints) const {
  std::vector<std::string> names;
  for (const std::size_t joint : joints) names.push_back(shown_.coordinate_names()[joint]);
  return names;
}

std::vector<std::size_t> Trajectories::moving_joints() const {
  std::vector<std::size_t> joints;
  for (std::size_t joint = 0; joint < followed_.joint_count(); ++joint)
    if (followed_.follows(joint)) joints.push_back(joint);
  return joints;
}

void Trajectories::stop(const std::vector<std::size_t>& joints) {
  change([&](TrajectoryFollower& follower, double now, const Simulation&) {
    for (const std::size_t joint : joints)
      if (follower.follows(joint)) follower.stop(joint, now, stop_duration_);
  });
}

void Trajectories::release(std::size_t coordinate, const std::string& reason) {
  if (!followed_.follows(coordinate)) return;
  change([&](TrajectoryFollower& follower, double, const Simulation&) { follower.release(coordinate); });
  const std::vector<std::size_t>& joints = goal_.joints;
  if (!action_.is_underway() || std::find(joints.begin(), joints.end(), coordinate) == joints.end()) return;
  stop(joints);
  action_.end(End::Aborted, Result::INVALID_GOAL, reason);
}

void Trajectories::release_all(const std::string& reason) {
  change([&](TrajectoryFollower& follower, double, const Simulation&) {
    for (std::size_t joint = 0; joint < follower.joint_count(); ++joint) follower.release(joint);
  });
  action_.end(End::Aborted, Result::INVALID_GOAL, reason);
}

}  // namespace flexarm::node
