// Released coordinates and their initial values.
#include <cmath>
#include <unordered_set>

#include "joints/joint_kinematics.h"
#include "math/so3.h"
#include "mechanism_builder.h"

namespace flexarm {

double MechanismBuilder::initial_position(const std::string& coordinate, double otherwise) const {
  const auto found = initial_positions_.find(coordinate);
  return found == initial_positions_.end() ? otherwise : found->second;
}

Released MechanismBuilder::initial_released(const JointMap& map, const std::vector<std::string>& names) const {
  Released out;
  std::vector<double> values;
  for (const std::string& name : names) values.push_back(initial_position(name));
  if (map.kind == JointMapKind::Scalar || map.kind == JointMapKind::Slide) {
    out.displacement[0] = values[0];
  } else if (map.kind != JointMapKind::Rigid) {
    if (map.kind == JointMapKind::Free) out.displacement = Vector3(values[0], values[1], values[2]);
    const std::size_t n = values.size();
    out.rotation = so3::exp_quaternion(Vector3(values[n - 3], values[n - 2], values[n - 1]));
  }
  return out;
}

void MechanismBuilder::add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names) {
  const int map = static_cast<int>(model.joints.size()) - 1;
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
    if (kind == JointMapKind::Scalar || kind == JointMapKind::Slide)
      coordinate.friction_coefficient =
          joint.friction_law.coefficient * (model.joints[map].rotation.isZero(0) ? 1.0 : joint.friction_law.radius);
    coordinate.effort_limit = joint.effort_limit;
    if (joint.limits) coordinate.limit = LimitStop{joint.limits->lower, joint.limits->upper};
    model.coordinates.push_back(coordinate);
  }
}

void MechanismBuilder::index_coordinates() {
  coordinate_indices_.clear();
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    coordinate_indices_.emplace(model.coordinates[i].name, static_cast<int>(i));
}

int MechanismBuilder::coordinate_index(const std::string& name, const std::string& where) const {
  if (const auto found = coordinate_indices_.find(name); found != coordinate_indices_.end()) return found->second;
  for (const LoopClosure& closure : model.closures)
    if (name.substr(0, closure.name.size()) == closure.name)
      throw ModelError(where + "joint '" + closure.name +
                       "' closes a loop of rigid links and has no coordinate there: name another joint of the loop, or "
                       "cut it there");
  throw ModelError(where + "there is no joint coordinate '" + name + "'");
}

void MechanismBuilder::connect_mimics() {
  index_coordinates();
  std::unordered_map<std::string, scene::Mimic> mimics;  // by joint; where known, of the coordinate at the chain's end
  for (const JointRecord& record : records_)
    if (record.joint->mimic) mimics[record.joint->name] = *record.joint->mimic;
  std::unordered_set<std::string> prescribed;
  for (const scene::PrescribedMotion& motion : scene_.motions) prescribed.insert(motion.coordinate);
  // Chains of mimics are followed to the coordinate that none of them mimics.
  for (const JointRecord& record : records_) {
    if (!record.joint->mimic) continue;
    const std::string where = at(record.joint->location, "<mimic> of joint '" + record.joint->name + "'");
    Coordinate& coordinate = model.coordinates[coordinate_index(record.joint->name, where)];
    scene::Mimic& mimic = mimics.at(record.joint->name);
    std::size_t depth = 0;
    for (auto next = mimics.find(mimic.joint); next != mimics.end(); next = mimics.find(mimic.joint)) {
      if (++depth > records_.size()) throw ModelError(where + "the mimicked joints form a circle");
      const scene::Mimic above = next->second;  // it may be the same one
      mimic.offset += mimic.multiplier * above.offset;
      mimic.multiplier *= above.multiplier;
      mimic.joint = above.joint;
    }
    if (prescribed.count(coordinate.name) > 0)
      throw ModelError(where + "the motion of the joint is prescribed as well");
    coordinate.mimicked = coordinate_index(mimic.joint, where);
    coordinate.mimic.multiplier = mimic.multiplier;
    coordinate.mimic.offset = mimic.offset;
    coordinate.limit.reset();
    if (model.joints[model.coordinates[coordinate.mimicked].joint].kind != JointMapKind::Scalar)
      throw ModelError(where + "only a joint with one coordinate can be mimicked");
    const Coordinate& base = model.coordinates[coordinate.mimicked];
    model.initial_released[coordinate.joint].displacement[0] =
        coordinate.mimic.value(model.initial_released[base.joint].displacement[0]);
  }
  update_initial_poses();
}

void MechanismBuilder::connect_coordinates() {
  index_coordinates();
  for (const scene::InitialJoint& initial : scene_.initial_joints)
    coordinate_index(initial.coordinate, at(initial.location, "<initial>"));
  for (const scene::PrescribedMotion& motion : scene_.motions) {
    const std::string where = at(motion.location, "<motion>");
    Coordinate& coordinate = model.coordinates[coordinate_index(motion.coordinate, where)];
    if (coordinate.is_angle)
      throw ModelError(where + "a component of a free rotation cannot be prescribed ('" + motion.coordinate + "')");
    coordinate.motion = add_history(motion.position);
    coordinate.limit.reset();
  }
  for (const scene::JointEffort& effort : scene_.efforts)
    model.coordinates[coordinate_index(effort.coordinate, at(effort.location, "<effort>"))].effort =
        add_history(effort.history);
}

void MechanismBuilder::update_initial_poses() {
  // Mimicking coordinates got their values after the nodes had been placed.
  std::vector<Pose> before;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) before.push_back(pose_of(static_cast<int>(i)));
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (const int joint = slave_joint_[i]; joint >= 0) {
      model.nodes[i] = slave_pose(model, joint, model.nodes, model.initial_released[joint]);
    } else {
      const int parent = node_parents[i];
      const Pose pose = pose_of(parent) * (before[parent].inverse() * before[i]);
      model.nodes[i].position = pose.position;
      model.nodes[i].orientation = pose.orientation;
      model.nodes[i].rotation = pose.orientation.toRotationMatrix();
    }
  }
}

}  // namespace flexarm
