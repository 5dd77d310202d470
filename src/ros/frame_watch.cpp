#include "frame_watch.h"

#include <ros/console.h>
#include <ros/this_node.h>

#include <utility>

namespace flexarm::node {

FrameWatch::FrameWatch(ros::NodeHandle& node, std::unordered_set<std::string> frames)
    : frames_(std::move(frames)), known_publishers_{ros::this_node::getName()} {
  subscriber_ = node.subscribe("/tf", 100, &FrameWatch::receive, this);
  static_subscriber_ = node.subscribe("/tf_static", 100, &FrameWatch::receive, this);
}

void FrameWatch::receive(const ros::MessageEvent<const tf2_msgs::TFMessage>& event) {
  const std::string& publisher = event.getPublisherName();
  if (known_publishers_.count(publisher) > 0) return;
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    std::string frame = transform.child_frame_id;
    if (!frame.empty() && frame.front() == '/') frame.erase(0, 1);  // tf names, before tf2, had a leading slash
    if (frames_.count(frame) == 0) continue;
    known_publishers_.insert(publisher);
    ROS_WARN_STREAM(publisher << " publishes the transform of '" << frame << "', which this node publishes from the "
                              << "deformed arm: the frame jumps between the two. End " << publisher
                              << ", or give one of them a frame prefix");
    return;
  }
}

}  // namespace flexarm::node
