#include "building/mechanism.h"

#include <algorithm>

#include "joints/joint_kinematics.h"
#include "joints/stop_restitution.h"

namespace flexarm {

Pose Mechanism::pose_of(int node) const {
  return node < 0 ? Pose() : Pose{model.nodes[node].position, model.nodes[node].orientation};
}

double Mechanism::extent() const {
  double extent = 0;
  for (const LinkFrame& link : model.links)
    if (link.beam) extent = std::max(extent, link.beam->length);
  const auto joint_of = [&](std::size_t node) {  // the place of the joint that moves the node, or of the node itself
    const int joint = slave_joint[node];
    return joint < 0 ? model.nodes[node].position : moved_origin(model.joints[joint], model.nodes[node]);
  };
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (const Vector3& point : {model.nodes[i].position, joint_of(i)})
      extent = std::max(extent, (point - joint_of(0)).norm());
  return extent > 0 ? extent : 1.0;
}

void Mechanism::reserve_nodes(std::size_t count) {
  count += model.nodes.size();
  model.nodes.reserve(count);
  model.inertias.reserve(count);
  node_parents.reserve(count);
  slave_joint.reserve(count);
}

int Mechanism::add_node(const Pose& pose, int parent) {
  NodePose node;
  node.position = pose.position;
  node.orientation = pose.orientation.normalized();
  node.rotation = node.orientation.toRotationMatrix();
  model.nodes.push_back(node);
  model.inertias.emplace_back();
  node_parents.push_back(parent);
  slave_joint.push_back(-1);
  return static_cast<int>(model.nodes.size()) - 1;
}

int Mechanism::add_map(JointMap map, const Released& released) {
  const int joint = static_cast<int>(model.joints.size());
  append_joint(map, released);
  const NodePose slave = slave_pose(model, joint, model.nodes, released);
  map.slave = model.joints[joint].slave = add_node({slave.position, slave.orientation}, map.master);
  slave_joint[map.slave] = joint;
  return map.slave;
}

void Mechanism::append_joint(const JointMap& map, const Released& released) {
  const auto place = static_cast<std::ptrdiff_t>(model.joints.size());
  if (model.joints.size_with_held() > model.joints.size())
    for (Coordinate& coordinate : model.coordinates)
      if (is_held(model, coordinate)) ++coordinate.joint;
  model.joints.push_back(map);
  model.initial_released.insert(model.initial_released.begin() + place, released);
  model.first_coordinate.insert(model.first_coordinate.begin() + place, static_cast<int>(model.coordinates.size()));
}

int Mechanism::append_held_joint(const JointMap& map, const Released& released) {
  model.joints.push_back_held(map);
  model.initial_released.push_back(released);
  model.first_coordinate.push_back(static_cast<int>(model.coordinates.size()));
  return static_cast<int>(model.joints.size_with_held()) - 1;
}

int Mechanism::add_rigid(int master, const Pose& offset) {
  JointMap map;
  map.master = master;
  map.origin.position = offset.position;
  map.slave_orientation = offset.orientation;
  return add_map(map, Released());
}

void Mechanism::move_nodes(const std::vector<Vector3>& ways) {
  for (std::size_t i = 0; i < ways.size(); ++i) model.nodes[i].position += model.nodes[i].rotation * ways[i];
  for (std::size_t j = 0; j < model.joints.size_with_held(); ++j) {
    JointMap& joint = model.joints[j];
    if (joint.slave >= 0) joint.arm += ways[joint.slave];
    if (joint.master >= 0) joint.origin.position -= ways[joint.master];
  }
  for (LinkFrame& link : model.links)
    if (link.frame.node >= 0) link.frame.offset.position -= ways[link.frame.node];
}

void Mechanism::add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names, int map) {
  const JointMapKind kind = model.joints[map].kind;
  for (std::size_t c = 0; c < names.size(); ++c) {
    Coordinate coordinate;
    coordinate.name = names[c];
    coordinate.joint = map;
    coordinate.component = static_cast<int>(c);
    coordinate.is_angle = kind == JointMapKind::Spherical || (kind == JointMapKind::Free && c >= 3);
    coordinate.damping = joint.damping;
    coordinate.friction = joint.friction;
    coordinate.sticks = joint.friction_law.law == scene::FrictionDescription::Law::Coulomb;
    coordinate.static_ratio = joint.friction_law.static_ratio;
    coordinate.stribeck_speed = joint.friction_law.stribeck_speed;
    if (kind == JointMapKind::Scalar || kind == JointMapKind::Slide)
      coordinate.friction_coefficient =
          joint.friction_law.coefficient * (model.joints[map].rotation.isZero(0) ? 1.0 : joint.friction_law.radius);
    coordinate.effort_limit = joint.effort_limit;
    if (joint.limits) {
      coordinate.limit = LimitStop{joint.limits->lower, joint.limits->upper};
      LimitStop& stop = *coordinate.limit;
      if (joint.limits->restitution) stop.damping_ratio = stop_damping_ratio(*joint.limits->restitution);
      stop.contact_time = joint.limits->contact_time.value_or(joint.limits->stiffness ? 0 : contact_time);
      stop.stiffness = joint.limits->stiffness.value_or(0);
    }
    model.coordinates.push_back(coordinate);
  }
}

Attachment attachment(const ScenePlan& plan, const Model& model, const std::string& link, const Vector3& point) {
  const int index = plan.links[link];
  const Attachment& frame = model.links[index].frame;
  if (!plan.meshes[index]) return frame;
  const auto& [centreline, mesh] = *plan.meshes[index];
  const int node = mesh.node_at(centreline.nearest(point));
  return {frame.node + node, mesh.nodes[node].pose.inverse()};
}

}  // namespace flexarm
