#include "state_publisher.h"

#include <unordered_map>

#include "advertise.h"
#include "conversions.h"

namespace flexarm::node {
namespace {

geometry_msgs::TransformStamped make_transform(const std::string& parent, const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1;
  return transform;
}

}  // namespace

StatePublisher::StatePublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                               const std::string& frame_prefix)
    : simulation_(simulation), schedule_(rate) {
  joint_states_.name = simulation.coordinate_names();
  joint_states_.position.resize(joint_states_.name.size());
  joint_states_.velocity.resize(joint_states_.name.size());
  joint_states_.effort.resize(joint_states_.name.size());

  joint_state_publisher_ =
      advertise<sensor_msgs::JointState>(node, "joint_states", 10, run, [this] { return joint_states_; });
  transform_publisher_ = advertise<tf2_msgs::TFMessage>(node, "/tf", 100, run, [this] { return transforms_; });
  static_transform_publisher_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 100, true);
  collect_frames(simulation.scene(), frame_prefix);
}

void StatePublisher::collect_frames(const scene::SceneDescription& scene, const std::string& prefix) {
  const std::vector<std::string>& links = simulation_.link_names();
  std::unordered_map<std::string, std::size_t> index_of;
  for (std::size_t link = 0; link < links.size(); ++link) index_of[links[link]] = link;

  tf2_msgs::TFMessage static_transforms;
  for (const scene::JointDescription& joint : scene.joints) {
    const Frame frame{index_of.at(joint.parent), index_of.at(joint.child)};
    geometry_msgs::TransformStamped transform = make_transform(prefix + joint.parent, prefix + joint.child);
    const bool rigid = !simulation_.is_flexible(frame.parent) && !simulation_.is_flexible(frame.child);
    if (joint.kind == scene::JointKind::Fixed && rigid) {
      transform.header.stamp = ros::Time::now();
      transform.transform = to_transform(joint.origin);
      static_transforms.transforms.push_back(transform);
    } else {
      frames_.push_back(frame);
      transforms_.transforms.push_back(transform);
    }
  }
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (!simulation_.is_flexible(link)) continue;
    flexible_links_.push_back(link);
    transforms_.transforms.push_back(make_transform(prefix + links[link], prefix + links[link] + "/tip"));
  }
  for (const auto* message : {&transforms_, &static_transforms})
    for (const auto& transform : message->transforms) frame_names_.insert(transform.child_frame_id);
  static_transform_publisher_.publish(static_transforms);
}

void StatePublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  publish_joint_states(stamp);
  publish_transforms(stamp);
}

void StatePublisher::publish_joint_states(const ros::Time& stamp) {
  joint_states_.header.stamp = stamp;
  for (std::size_t coordinate = 0; coordinate < joint_states_.name.size(); ++coordinate) {
    joint_states_.position[coordinate] = simulation_.position(coordinate);
    joint_states_.velocity[coordinate] = simulation_.velocity(coordinate);
    joint_states_.effort[coordinate] = simulation_.effort(coordinate);
  }
  joint_state_publisher_.publish(joint_states_);
}

void StatePublisher::publish_transforms(const ros::Time& stamp) {
  auto transform = transforms_.transforms.begin();
  for (const Frame& frame : frames_) {
    const Pose pose = simulation_.link_pose(frame.parent).inverse() * simulation_.link_pose(frame.child);
    transform->header.stamp = stamp;
    transform->transform = to_transform(pose);
    ++transform;
  }
  for (const std::size_t link : flexible_links_) {
    transform->header.stamp = stamp;
    transform->transform = to_transform(simulation_.link_pose(link).inverse() * simulation_.tip_pose(link));
    ++transform;
  }
  transform_publisher_.publish(transforms_);
}

}  // namespace flexarm::node
