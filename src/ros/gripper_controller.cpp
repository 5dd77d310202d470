#include "gripper_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace flexarm::node {
namespace {

constexpr double kGripFeedbackPeriod = 0.05;  ///< simulated [s]

}  // namespace

GripperController::GripperController(ros::NodeHandle& node, const ControllerDescription& description, Motions& motions,
                                     Take take)
    : JointController(motions, std::move(take)),
      description_(description),
      action_(node, description.action,
              {[this](const control::GripperCommandGoal& message) { return follow_goal(message); },
               [this](GoalEnd how, const std::string& reason) { end(how, reason); }, [this] { hold(); }}) {}

std::vector<Motions::Target> GripperController::targets_of(double position) const {
  const std::vector<std::string>& joints = description_.joints;
  if (description_.is_parallel) {
    const DrivenBy first = driven_by(motions_.shown(), joints[0]), second = driven_by(motions_.shown(), joints[1]);
    if (first.coordinate != second.coordinate)
      return {{first.coordinate, 0.5 * position}, {second.coordinate, 0.5 * position}};
    return {{first.coordinate, (position - first.offset - second.offset) / (first.multiplier + second.multiplier)}};
  }
  std::vector<Motions::Target> targets;
  const DrivenBy commanded = driven_by(motions_.shown(), description_.command_joint);
  targets.push_back({commanded.coordinate, (position - commanded.offset) / commanded.multiplier});
  for (const std::string& joint : joints)
    if (const DrivenBy driven = driven_by(motions_.shown(), joint); driven.coordinate != commanded.coordinate)
      targets.push_back({driven.coordinate, (position - driven.offset) / driven.multiplier});
  return targets;
}

std::optional<GripperController::Server::Rejection> GripperController::follow_goal(
    const control::GripperCommandGoal& message) {
  const double position = message.command.position, max_effort = message.command.max_effort;
  std::string fault = motions_.refusal();
  if (fault.empty() && (!std::isfinite(position) || std::isnan(max_effort)))
    fault = fmt::format("position and max_effort must be numbers, got {} and {}", position, max_effort);
  std::vector<Motions::Target> targets;
  try {
    if (fault.empty()) targets = targets_of(position);
  } catch (const std::invalid_argument& error) {  // the scene was replaced, and a joint may be gone
    fault = error.what();
  }
  if (fault.empty()) fault = motions_.grip(targets, max_effort > 0 ? max_effort : description_.max_effort);
  if (!fault.empty()) return Server::Rejection{{}, fault};
  targets_ = std::move(targets);
  joints_.clear();
  for (const Motions::Target& target : targets_) joints_.push_back(target.joint);
  take_(joints_);
  begins_ = true;
  next_feedback_ = 0;
  return std::nullopt;
}

void GripperController::judge(double now) {
  if (!is_underway()) return;
  if (std::exchange(begins_, false) || is_moving()) last_motion_ = now;
  Result found = result();
  found.reached_goal = is_at_goal();
  found.stalled = !found.reached_goal && now - last_motion_ > description_.stall_timeout;
  if (found.reached_goal) return action_.end(GoalEnd::Succeeded, found, "");
  if (found.stalled) {
    const std::string text = fmt::format("stalled at {:.4g}, with an effort of {:.4g}", found.position, found.effort);
    return action_.end(GoalEnd::Aborted, found, text);
  }
  if (now < next_feedback_) return;
  next_feedback_ = now + kGripFeedbackPeriod;
  control::GripperCommandFeedback feedback;
  feedback.position = found.position;
  feedback.effort = found.effort;
  action_.publish_feedback(feedback);
}

void GripperController::end(GoalEnd how, const std::string& reason) {
  if (is_underway()) action_.end(how, result(), reason);
}

void GripperController::renumber(const Renumbering::Places& joints) {
  JointController::renumber(joints);
  targets_.resize(joints_.size());
  for (std::size_t k = 0; k < joints_.size(); ++k) targets_[k].joint = joints_[k];
}

void GripperController::hold() {
  std::vector<Motions::Target> here;
  for (const std::size_t joint : joints_) here.push_back({joint, motions_.shown().position(joint)});
  motions_.grip(here, description_.max_effort);
}

GripperController::Result GripperController::result() const {
  const Simulation& shown = motions_.shown();
  Result out;
  out.position = 0;
  for (const std::string& joint : description_.joints) {
    if (!description_.is_parallel && joint != description_.command_joint) continue;
    if (const auto coordinate = shown.find_coordinate(joint)) out.position += shown.position(*coordinate);
  }
  if (!joints_.empty() && joints_.front() < shown.coordinate_names().size()) out.effort = shown.effort(joints_.front());
  return out;
}

bool GripperController::is_at_goal() const {
  return std::all_of(targets_.begin(), targets_.end(), [this](const Motions::Target& target) {
    return std::abs(motions_.shown().position(target.joint) - target.position) < description_.goal_tolerance;
  });
}

bool GripperController::is_moving() const {
  return std::any_of(joints_.begin(), joints_.end(), [this](std::size_t joint) {
    return std::abs(motions_.shown().velocity(joint)) > description_.stall_velocity;
  });
}

}  // namespace flexarm::node
