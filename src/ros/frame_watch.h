#pragma once
/// Somebody else who publishes this arm's frames.

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <unordered_set>
#include <utility>

namespace flexarm::node {

/// Listens to /tf and /tf_static, and warns once of every other node that publishes one of these frames: as
/// robot_state_publisher does, or a second arm without a frame prefix.
class FrameWatch {
 public:
  FrameWatch(ros::NodeHandle& node, std::unordered_set<std::string> frames);
  /// Others are this arm's now.
  void watch(std::unordered_set<std::string> frames) { frames_ = std::move(frames); }
  FrameWatch(const FrameWatch&) = delete;
  FrameWatch& operator=(const FrameWatch&) = delete;

 private:
  void receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event);

  std::unordered_set<std::string> frames_, known_publishers_;
  ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace flexarm::node
