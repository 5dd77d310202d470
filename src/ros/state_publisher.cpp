#include "state_publisher.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "advertise.h"

namespace flexarm::node {
namespace {

/// Of publishers at this rate [Hz]. Subscribers that read in bursts lose no message within a second.
std::uint32_t queue_size(double rate) {
  return static_cast<std::uint32_t>(std::clamp(rate, 100.0, 1e5));
}

}  // namespace

StatePublisher::StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                               const std::string& frame_prefix)
    : simulation_(simulation),
      frame_prefix_(frame_prefix),
      schedule_(rate),
      joint_state_publisher_(advertise<sensor_msgs::JointState>(node, "joint_states", queue_size(rate), run,
                                                                [this] { return joint_states(); })),
      transform_publisher_(
          advertise<tf2_msgs::TFMessage>(node, "/tf", queue_size(rate), run, [this] { return transforms(); })) {
  adopt_scene();
}

void StatePublisher::adopt_scene() {
  messages_.emplace(simulation_, frame_prefix_);
  send_static_transforms();
}

void StatePublisher::send_static_transforms() {
  // A static broadcaster never forgets a frame. The new one begins before the old one ends, so that the topic stays.
  auto broadcaster = std::make_unique<tf2_ros::StaticTransformBroadcaster>();
  broadcaster->sendTransform(messages_->static_transforms(ros::Time::now()).transforms);
  static_transform_broadcaster_ = std::move(broadcaster);
}

void StatePublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  publish_to_listeners(
      joint_state_publisher_, [this]() -> const auto& { return joint_states(); });
  if (transform_publisher_.getNumSubscribers() > 0) transform_broadcaster_.sendTransform(transforms().transforms);
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
