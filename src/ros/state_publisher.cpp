#include "state_publisher.h"

#include <algorithm>
#include <cstdint>

#include "advertise.h"

namespace flexarm::node {

StatePublisher::StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                               const std::string& frame_prefix)
    : simulation_(simulation), frame_prefix_(frame_prefix), schedule_(rate) {
  // Subscribers that read in bursts lose no message within a second.
  const auto queue_size = static_cast<std::uint32_t>(std::clamp(rate, 100.0, 1e5));
  joint_state_publisher_ =
      advertise<sensor_msgs::JointState>(node, "joint_states", queue_size, run, [this] { return joint_states(); });
  transform_publisher_ = advertise<tf2_msgs::TFMessage>(node, "/tf", queue_size, run, [this] { return transforms(); });
  static_transform_publisher_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 100, true);
  adopt_scene();
}

void StatePublisher::adopt_scene() {
  messages_.emplace(simulation_, frame_prefix_);
  static_transform_publisher_.publish(messages_->static_transforms(ros::Time::now()));
}

void StatePublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  publish_to_listeners(
      joint_state_publisher_, [this]() -> const auto& { return joint_states(); });
  publish_to_listeners(
      transform_publisher_, [this]() -> const auto& { return transforms(); });
}

const sensor_msgs::JointState& StatePublisher::joint_states() {
  messages_->update_joint_states(stamp_);
  return messages_->joint_states();
}

const tf2_msgs::TFMessage& StatePublisher::transforms() {
  messages_->update_transforms(stamp_);
  return messages_->transforms();
}

}  // namespace flexarm::node
