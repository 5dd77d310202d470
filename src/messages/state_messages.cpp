#include "messages/state_messages.h"

#include <unordered_map>

#include "flexarm/scene/scene_description.h"
#include "messages/conversions.h"

namespace flexarm::messages {
namespace {

geometry_msgs::TransformStamped make_transform(const std::string& parent, const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1;
  return transform;
}

}  // namespace

StateMessages::StateMessages(const Simulation& simulation, const std::string& prefix) : simulation_(simulation) {
  joint_states_.name = simulation.coordinate_names();
  joint_states_.position.resize(joint_states_.name.size());
  joint_states_.velocity.resize(joint_states_.name.size());
  joint_states_.effort.resize(joint_states_.name.size());

  const std::vector<std::string>& links = simulation_.link_names();
  std::unordered_map<std::string, std::size_t> index_of;
  for (std::size_t link = 0; link < links.size(); ++link) index_of[links[link]] = link;
  for (const scene::JointDescription& joint : simulation.scene().joints) {
    const Frame frame{index_of.at(joint.parent), index_of.at(joint.child)};
    geometry_msgs::TransformStamped transform = make_transform(prefix + joint.parent, prefix + joint.child);
    const bool rigid = !simulation_.is_flexible(frame.parent) && !simulation_.is_flexible(frame.child);
    if (joint.kind == scene::JointKind::Fixed && rigid) {
      transform.transform = to_transform(joint.origin);
      static_transforms_.transforms.push_back(transform);
    } else {
      frames_.push_back(frame);
      transforms_.transforms.push_back(transform);
    }
  }
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (!simulation.scene().links[link].beam) continue;
    geometry_msgs::TransformStamped transform = make_transform(prefix + links[link], prefix + links[link] + "/tip");
    if (simulation_.is_flexible(link)) {
      flexible_links_.push_back(link);
      transforms_.transforms.push_back(transform);
    } else {
      transform.transform = to_transform(simulation_.link_pose(link).inverse() * simulation_.tip_pose(link));
      static_transforms_.transforms.push_back(transform);
    }
  }
  for (const auto* message : {&transforms_, &static_transforms_})
    for (const auto& transform : message->transforms) frame_names_.insert(transform.child_frame_id);
}

void StateMessages::update_joint_states(const ros::Time& stamp) {
  joint_states_.header.stamp = stamp;
  for (std::size_t coordinate = 0; coordinate < joint_states_.name.size(); ++coordinate) {
    joint_states_.position[coordinate] = simulation_.position(coordinate);
    joint_states_.velocity[coordinate] = simulation_.velocity(coordinate);
    joint_states_.effort[coordinate] = simulation_.effort(coordinate);
  }
}

void StateMessages::update_transforms(const ros::Time& stamp) {
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
}

tf2_msgs::TFMessage StateMessages::static_transforms(const ros::Time& stamp) const {
  tf2_msgs::TFMessage message = static_transforms_;
  for (geometry_msgs::TransformStamped& transform : message.transforms) transform.header.stamp = stamp;
  return message;
}

}  // namespace flexarm::messages
