// Joints that close loops: where it can be, the slave is a beam's node that was free before. (joints.md 3)
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "joints/joint_kinematics.h"
#include "mechanism_builder.h"

namespace flexarm {
namespace {

/// Gap between the frames of a closing joint, relative to the extent of the mechanism, that is taken for rounding of
/// the scene's numbers.
constexpr double kLargestGap = 1e-6;

/// Nodes from whose poses a joint computes its slave's; none for the world.
std::vector<int> masters(const Model& model, const JointMap& joint) {
  if (joint.kind == JointMapKind::Slide) return model.slide_lines[joint.line].nodes;
  return joint.master < 0 ? std::vector<int>() : std::vector<int>{joint.master};
}

/// Turns a map round: its master's pose from its slave's, as a function of the same coordinate. False where that is no
/// elementary joint.
bool invert(JointMap& map) {
  // Travel and turn must commute: T(t) R(a) backwards is R(-a) T(-t).
  const double across = map.translation.cross(map.rotation).norm();
  if (map.kind != JointMapKind::Scalar || !map.origin.position.isZero(0) ||
      across > 1e-12 * map.translation.norm() * map.rotation.norm())
    return false;
  map.translation = -map.translation;
  map.rotation = -map.rotation;
  return true;
}

}  // namespace

double MechanismBuilder::extent() const {
  double extent = 0;
  for (const LinkFrame& link : model.links)
    if (link.beam) extent = std::max(extent, link.beam->length);
  for (const NodePose& a : model.nodes) extent = std::max(extent, (a.position - model.nodes.front().position).norm());
  return extent > 0 ? extent : 1.0;
}

Attachment MechanismBuilder::carrier(Attachment frame) const {
  while (frame.node >= 0 && slave_joint_[frame.node] >= 0) {
    const JointMap& map = model.joints[slave_joint_[frame.node]];
    if (map.kind != JointMapKind::Rigid) break;
    frame.offset = map.origin * Pose{Vector3::Zero(), map.slave_orientation} * frame.offset;
    frame.node = map.master;
  }
  return frame;
}

bool MechanismBuilder::can_become_slave(int node, int master) const {
  if (node < 0 || slave_joint_[node] >= 0) return false;
  std::unordered_set<int> seen;
  std::vector<int> stack(master < 0 ? 0 : 1, master);  // nodes whose poses the master's depends on
  while (!stack.empty()) {
    const int above = stack.back();
    stack.pop_back();
    if (above == node) return false;
    if (!seen.insert(above).second || slave_joint_[above] < 0) continue;
    const std::vector<int> next = masters(model, model.joints[slave_joint_[above]]);
    stack.insert(stack.end(), next.begin(), next.end());
  }
  return true;
}

void MechanismBuilder::close_loops() {
  const double largest_gap = kLargestGap * extent();
  for (const scene::JointDescription& joint : scene_.loop_joints) add_loop(joint, largest_gap);
  if (!scene_.loop_joints.empty()) sort_joints();
}

Attachment MechanismBuilder::loop_child(const scene::JointDescription& joint) const {
  const Attachment nearest = attachment(joint.child, joint.child_origin.position);
  const int link = link_index(joint.child);
  const std::optional<LinkMesh>& beam = meshes[link];
  if (!beam || joint.parent != joint.child || !beam->centreline.is_closed()) return nearest;
  if (nearest.node != beam->first_node || attachment(joint.parent, joint.origin.position).node != nearest.node)
    return nearest;
  const int end = beam->mesh.node_at(beam->centreline.length());
  return {beam->first_node + end, beam->mesh.nodes[end].pose.inverse()};
}

void MechanismBuilder::add_loop(const scene::JointDescription& joint, double largest_gap) {
  const std::string where = at(joint.location, "<loop_joint> '" + joint.name + "'");
  if (joint.kind == scene::JointKind::Slide || joint.kind == scene::JointKind::Floating || joint.mimic)
    throw ModelError(where + "a loop cannot be closed by a slide, a free or a mimicking joint");
  const Attachment parent = carrier(attachment(joint.parent, joint.origin.position));
  const Attachment child = carrier(loop_child(joint));
  const Pose frame = pose_of(parent.node) * parent.offset * joint.origin;
  std::vector<JointMap> maps;
  if (joint.kind != scene::JointKind::Fixed) maps = elementary_joints(joint);

  NodePose meeting{frame.position, frame.orientation, frame.orientation.toRotationMatrix()};
  for (const JointMap& map : maps) meeting = slave_pose(map, meeting, Released());
  const Pose child_frame = pose_of(child.node) * child.offset * joint.child_origin;
  const double gap = (meeting.position - child_frame.position).norm();
  if (!(gap <= largest_gap))
    throw ModelError(where + "the loop is open at the start: the joint's frames in parent and child are " +
                     std::to_string(gap) + " m apart");

  const bool onto_child = can_become_slave(child.node, parent.node);
  if (!onto_child && !can_become_slave(parent.node, child.node)) {
    add_closure(joint, parent, child, frame);
    return;
  }
  std::vector<std::string> names;
  for (const std::string& suffix : scene::coordinate_suffixes(joint)) names.push_back(joint.name + suffix);
  for (const std::string& name : names)
    if (initial_position(name) != 0)
      throw ModelError(where + "its coordinates are 0 at the start; '" + name + "' cannot start elsewhere");
  if (!onto_child) {
    std::reverse(maps.begin(), maps.end());
    std::reverse(names.begin(), names.end());
    for (JointMap& map : maps)
      if (!invert(map))
        throw ModelError(where +
                         "only the parent's end is free, and this kind of joint needs the child's: exchange <parent> "
                         "and <child>");
  }
  chain_loop(joint, maps, names, onto_child ? parent.node : child.node, onto_child ? child.node : parent.node,
             onto_child ? frame : Pose{meeting.position, frame.orientation});
}

void MechanismBuilder::chain_loop(const scene::JointDescription& joint, const std::vector<JointMap>& maps,
                                  const std::vector<std::string>& names, int master, int slave, const Pose& frame) {
  JointRecord record{&joint, static_cast<int>(model.joints.size()), static_cast<int>(maps.size()) + 1, slave};
  int node = master;
  std::size_t name = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    JointMap map = maps[k];
    map.master = node;
    if (k == 0) map.origin = pose_of(master).inverse() * frame * map.origin;
    node = add_map(map, Released());
    const std::size_t count = released_count(map.kind);
    add_coordinates(joint, {names.begin() + name, names.begin() + name + count});
    name += count;
  }
  if (!names.empty() && names.front() != joint.name + scene::coordinate_suffixes(joint).front()) {
    // The chain is turned round; coordinates are numbered as their names are.
    const std::size_t first = model.coordinates.size() - names.size();
    std::reverse(model.coordinates.begin() + static_cast<std::ptrdiff_t>(first), model.coordinates.end());
    for (std::size_t i = first; i < model.coordinates.size(); ++i)
      model.first_coordinate[model.coordinates[i].joint] = static_cast<int>(i);
  }
  // The slave as it stands at the start: zero of the coordinates is the initial configuration.
  const Pose offset = pose_of(node).inverse() * pose_of(slave);
  JointMap rigid;
  rigid.master = node;
  rigid.slave = slave;
  rigid.origin.position = offset.position;
  rigid.slave_orientation = offset.orientation;
  slave_joint_[slave] = static_cast<int>(model.joints.size());
  model.joints.push_back(rigid);
  model.initial_released.push_back(Released());
  model.first_coordinate.push_back(static_cast<int>(model.coordinates.size()));
  records_.push_back(record);
}

void MechanismBuilder::sort_joints() {
  std::vector<int> order, place(model.joints.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    std::vector<int> stack = {static_cast<int>(j)};
    while (!stack.empty()) {
      const int next = stack.back();
      const std::size_t waiting = stack.size();
      if (place[next] < 0)
        for (const int master : masters(model, model.joints[next]))
          if (slave_joint_[master] >= 0 && place[slave_joint_[master]] < 0) stack.push_back(slave_joint_[master]);
      if (stack.size() > waiting) continue;
      stack.pop_back();
      if (place[next] >= 0) continue;
      place[next] = static_cast<int>(order.size());
      order.push_back(next);
    }
  }
  const auto permute = [&](auto& values) {
    const auto before = values;
    for (std::size_t k = 0; k < order.size(); ++k) values[k] = before[order[k]];
  };
  for (int& joint : slave_joint_)
    if (joint >= 0) joint = place[joint];
  permute(model.joints);
  permute(model.initial_released);
  permute(model.first_coordinate);
  for (JointMap& joint : model.joints)
    if (joint.leaving >= 0) joint.leaving = place[joint.leaving];
  for (Coordinate& coordinate : model.coordinates) coordinate.joint = place[coordinate.joint];
  // A chain stays together: nothing but its next joint hangs on a node inside it.
  for (JointRecord& record : records_)
    if (record.map_count > 0) record.first_map = place[record.first_map];
}

}  // namespace flexarm
