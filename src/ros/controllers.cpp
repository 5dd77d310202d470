#include "controllers.h"

#include <utility>

#include "gripper_controller.h"
#include "trajectory_controller.h"

namespace flexarm::node {
namespace {

constexpr int kTrajectoryQueueSize = 10;

}  // namespace

Controllers::Controllers(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown,
                         SteppingThread& stepping, Motions::Context context,
                         std::function<void(const std::string&)> warn)
    : motions_(shown, stepping, std::move(context)), warn_(std::move(warn)) {
  for (const ControllerDescription& description : read_controllers(private_node, shown)) add(node, description);
  subscriber_ = node.subscribe("joint_trajectory", kTrajectoryQueueSize, &Controllers::receive, this,
                               ros::TransportHints().tcpNoDelay());
}

void Controllers::add(ros::NodeHandle& node, const ControllerDescription& description) {
  const std::size_t index = controllers_.size();
  const auto take = [this, index](const std::vector<std::size_t>& joints) { this->take(index, joints); };
  if (description.type == ControllerDescription::Type::GripperCommand)
    controllers_.push_back(std::make_unique<GripperController>(node, description, motions_, take));
  else
    controllers_.push_back(std::make_unique<TrajectoryController>(node, description, motions_, take));
}

void Controllers::judge(double now) {
  motions_.release_arrived(now);
  for (const auto& controller : controllers_) controller->judge(now);
}

void Controllers::take(std::size_t taker, const std::vector<std::size_t>& joints) {
  for (std::size_t i = 0; i < controllers_.size(); ++i)
    for (const std::size_t joint : joints)
      if (i != taker && controllers_[i]->has_goal_for(joint))
        controllers_[i]->end(GoalEnd::Canceled, "another goal or trajectory has replaced it for '" +
                                                    motions_.shown().coordinate_names()[joint] + "'");
}

void Controllers::release(std::size_t coordinate, const std::string& reason) {
  motions_.release(coordinate);
  for (const auto& controller : controllers_)
    if (controller->has_goal_for(coordinate)) controller->abort(reason);
}

void Controllers::renumber(const Renumbering& places) {
  for (std::size_t i = 0; i < places.coordinates.size(); ++i)
    if (!places.coordinates[i]) release(i, "joint '" + motions_.shown().coordinate_names()[i] + "' was removed");
  for (const auto& controller : controllers_) controller->renumber(places.coordinates);
}

void Controllers::release_all(const std::string& reason) {
  motions_.release_all();
  for (const auto& controller : controllers_) controller->end(GoalEnd::Aborted, reason);
}

void Controllers::receive(const trajectory_msgs::JointTrajectory& message) {
  std::vector<std::size_t> joints;
  const Motions::Fault fault = motions_.follow(message, {}, joints);
  if (!fault.is_none()) return warn_(fault.text);
  if (!motions_.command_step())
    warn_("the trajectory is followed, but without a step of its own: too many steps are waiting already");
  take(controllers_.size(), joints);
}

}  // namespace flexarm::node
