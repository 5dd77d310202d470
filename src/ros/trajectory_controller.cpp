#include "trajectory_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flexarm::node {
namespace {

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

TrajectoryController::TrajectoryController(ros::NodeHandle& node, const ControllerDescription& description,
                                           Motions& motions, Take take)
    : JointController(motions, std::move(take)),
      group_(description.joints),
      action_(
          node, description.action,
          {[this](const control::FollowJointTrajectoryGoal& message) { return follow_goal(message); },
           [this](GoalEnd how, const std::string& reason) { end(how, reason); }, [this] { motions_.stop(joints_); }}) {}

void TrajectoryController::judge(double now) {
  if (!is_underway()) return;
  using Verdict = TrajectoryGoal::Verdict;
  desired_.clear();
  actual_.clear();
  for (const std::size_t joint : joints_) {
    desired_.push_back(motions_.at(joint, now));
    actual_.push_back({motions_.shown().position(joint), motions_.shown().velocity(joint)});
  }
  const TrajectoryGoal::Judgement judgement = goal_.judge(now, desired_, actual_);
  if (judgement.verdict == Verdict::Reached) return end(GoalEnd::Succeeded, Result::SUCCESSFUL, "");
  if (judgement.verdict == Verdict::Underway) return publish_feedback(now);
  const bool is_path = judgement.verdict == Verdict::OffPath;
  const std::string& name = motions_.shown().coordinate_names()[joints_[judgement.joint]];
  const std::string text = fmt::format("'{}' is {} by {:.3g} in {}, more than {:.3g}, at {:.3f} s", name,
                                       is_path ? "off its path" : "not at its goal", judgement.error,
                                       judgement.quantity, judgement.allowed, motions_.shown().time());
  motions_.stop(joints_);
  end(GoalEnd::Aborted, is_path ? Result::PATH_TOLERANCE_VIOLATED : Result::GOAL_TOLERANCE_VIOLATED, text);
}

void TrajectoryController::publish_feedback(double now) {
  if (now < next_feedback_) return;
  next_feedback_ = now + kFeedbackPeriod;
  control::FollowJointTrajectoryFeedback feedback;
  feedback.header.stamp = ros::Time::now();
  feedback.joint_names = motions_.names_of(joints_);
  std::vector<JointPoint> error;
  for (std::size_t k = 0; k < desired_.size(); ++k)
    error.push_back({desired_[k].position - actual_[k].position, desired_[k].velocity - actual_[k].velocity});
  feedback.desired = message_of(desired_);
  feedback.actual = message_of(actual_);
  feedback.error = message_of(error);
  action_.publish_feedback(feedback);
}

void TrajectoryController::end(GoalEnd how, const std::string& reason) {
  end(how, how == GoalEnd::Aborted ? Result::INVALID_GOAL : Result::SUCCESSFUL, reason);
}

void TrajectoryController::renumber(const Renumbering::Places& joints) {
  JointController::renumber(joints);
  goal_.joints = joints_;
}

void TrajectoryController::end(GoalEnd how, int code, const std::string& text) {
  Result result;
  result.error_code = code;
  result.error_string = text;
  action_.end(how, result, text);
}

std::optional<TrajectoryController::Server::Rejection> TrajectoryController::follow_goal(
    const control::FollowJointTrajectoryGoal& message) {
  TrajectoryGoal goal;
  const std::vector<std::string>& names = message.trajectory.joint_names;
  Motions::Fault fault{Result::INVALID_GOAL, fault_of_tolerances(message.path_tolerance, names)};
  if (fault.is_none()) fault.text = fault_of_tolerances(message.goal_tolerance, names);
  if (fault.is_none()) fault = motions_.follow(message.trajectory, group_, goal.joints);
  if (!fault.is_none()) {
    Result result;
    result.error_code = fault.code;
    result.error_string = fault.text;
    return Server::Rejection{result, fault.text};
  }
  take_(goal.joints);
  const std::vector<std::string> joints = motions_.names_of(goal.joints);
  goal.path = tolerances_of(message.path_tolerance, joints);
  goal.at_end = tolerances_of(message.goal_tolerance, joints);
  for (const std::size_t joint : goal.joints) goal.end = std::max(goal.end, motions_.end(joint));
  goal.patience = std::max(message.goal_time_tolerance.toSec(), 0.0);
  joints_ = goal.joints;
  goal_ = std::move(goal);
  next_feedback_ = 0;
  return std::nullopt;
}

}  // namespace flexarm::node
