#pragma once
/// Warns if another node publishes frames of this arm.

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <unordered_set>
#include <utility>

namespace flexarm::node {

/// Listens to /tf and /tf_static. Warns once of each other node that publishes one of the given frames, such as a
/// robot_state_publisher or a second arm without a frame prefix.
class FrameWatch {
 public:
  FrameWatch(ros::NodeHandle& node, std::unordered_set<std::string> frames);
  /// Replaces the set of frames.
  void watch(std::unordered_set<std::string> frames) { frames_ = std::move(frames); }
  FrameWatch(const FrameWatch&) = delete;
  FrameWatch& operator=(const FrameWatch&) = delete;

 private:
  void receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event);

  std::unordered_set<std::string> frames_, known_publishers_;
  ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace flexarm::node
