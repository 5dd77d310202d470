#include "building/passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "building/elementary_joints.h"
#include "building/model_builder.h"
#include "building/places_at_start.h"
#include "joints/joint_kinematics.h"

namespace flexarm {
namespace {

/// Nodes whose poses determine the pose of a joint's slave; none for the world.
std::vector<int> masters(const Model& model, const JointMap& joint) {
  if (joint.kind == JointMapKind::Slide) return model.slide_lines[joint.line].nodes;
  return joint.master < 0 ? std::vector<int>() : std::vector<int>{joint.master};
}

/// Reverses a map, so that it gives the master's pose from the slave's for the same coordinate. Returns false if the
/// reversed map is no elementary joint.
bool invert(JointMap& map) {
  // Travel and turn must commute, since the reverse of T(t) R(a) is R(-a) T(-t).
  const double across = map.translation.cross(map.rotation).norm();
  if (map.kind != JointMapKind::Scalar || !map.origin.position.isZero(0) ||
      across > 1e-12 * map.translation.norm() * map.rotation.norm())
    return false;
  map.translation = -map.translation;
  map.rotation = -map.rotation;
  return true;
}

class LoopBuilder {
 public:
  LoopBuilder(const ScenePlan& plan, Mechanism& mechanism)
      : plan_(plan), mechanism_(mechanism), model_(mechanism.model), largest_gap_(kLargestGap * mechanism.extent()) {}

  void add(const scene::JointDescription& joint);

 private:
  /// The same frame, relative to the node at the root of the rigid body to which it is fixed.
  Attachment carrier(Attachment frame) const;
  /// Whether the node is free, and `master` does not depend on it.
  bool can_become_slave(int node, int master) const;
  /// The node at which the child is held, with the link's frame. If a flexible link is joined to itself at the
  /// beginning of a closed line, it is the node at the line's end.
  Attachment child_place(const scene::JointDescription& joint) const;
  /// Adds the chain of a joint from `master`, through `maps`, of which the first is at `frame` (world), to the existing
  /// node `slave`.
  void add_chain(const scene::JointDescription& joint, const std::vector<JointMap>& maps,
                 const std::vector<std::string>& names, int master, int slave, const Pose& frame);

  const ScenePlan& plan_;
  Mechanism& mechanism_;
  Model& model_;
  double largest_gap_;  // between a joint's frames at the start [m]
};

Attachment LoopBuilder::carrier(Attachment frame) const {
  while (frame.node >= 0 && mechanism_.slave_joint[frame.node] >= 0) {
    const JointMap& map = model_.joints[mechanism_.slave_joint[frame.node]];
    if (map.kind != JointMapKind::Rigid) break;
    frame.offset = map.origin * Pose{map.slave_orientation * map.arm, map.slave_orientation} * frame.offset;
    frame.node = map.master;
  }
  return frame;
}

bool LoopBuilder::can_become_slave(int node, int master) const {
  if (node < 0 || mechanism_.slave_joint[node] >= 0) return false;
  std::unordered_set<int> seen;
  std::vector<int> stack(master < 0 ? 0 : 1, master);  // nodes whose poses the master's depends on
  while (!stack.empty()) {
    const int above = stack.back();
    stack.pop_back();
    if (above == node) return false;
    if (!seen.insert(above).second || mechanism_.slave_joint[above] < 0) continue;
    const std::vector<int> next = masters(model_, model_.joints[mechanism_.slave_joint[above]]);
    stack.insert(stack.end(), next.begin(), next.end());
  }
  return true;
}

Attachment LoopBuilder::child_place(const scene::JointDescription& joint) const {
  Attachment nearest = attachment(plan_, model_, joint.child, joint.child_origin.position);
  const int link = plan_.links[joint.child];
  const std::optional<LinkMesh>& beam = plan_.meshes[link];
  if (!beam || joint.parent != joint.child || !beam->centreline.is_closed()) return nearest;
  const int first_node = model_.links[link].frame.node;
  if (nearest.node != first_node || attachment(plan_, model_, joint.parent, joint.origin.position).node != nearest.node)
    return nearest;
  const int end = beam->mesh.node_at(beam->centreline.length());
  return {first_node + end, beam->mesh.nodes[end].pose.inverse()};
}

void LoopBuilder::add(const scene::JointDescription& joint) {
  const std::string where = at(joint.location, "<loop_joint> '" + joint.name + "'");
  if (joint.kind == scene::JointKind::Slide || joint.kind == scene::JointKind::Floating || joint.mimic)
    throw ModelError(where + "a loop cannot be closed by a slide, a free or a mimicking joint");
  const Attachment parent = carrier(attachment(plan_, model_, joint.parent, joint.origin.position));
  const Attachment child = carrier(child_place(joint));
  const Pose frame = mechanism_.pose_of(parent.node) * parent.offset * joint.origin;
  std::vector<JointMap> maps = elementary_joints(joint);
  NodePose meeting{frame.position, frame.orientation, frame.orientation.toRotationMatrix()};
  for (const JointMap& map : maps) meeting = slave_pose(map, meeting, Released());
  const double gap =
      loop_gap(joint, mechanism_.pose_of(parent.node) * parent.offset, mechanism_.pose_of(child.node) * child.offset);
  if (!(gap <= largest_gap_))
    throw ModelError(where + "the loop is open at the start: the joint's frames in parent and child are " +
                     std::to_string(gap) + " m apart");

  const bool onto_child = can_become_slave(child.node, parent.node);
  if (!onto_child && !can_become_slave(parent.node, child.node)) {
    model_.closures.push_back(loop_closure(plan_, mechanism_, joint, parent, child, frame));
    return;
  }
  std::vector<std::string> names = coordinate_names(joint);
  for (const std::string& name : names)
    if (plan_.initial_positions.of(name) != 0)
      throw ModelError(fmt::format("{}its coordinates are 0 at the start; '{}' cannot start elsewhere", where, name));
  if (!onto_child) {
    std::reverse(maps.begin(), maps.end());
    std::reverse(names.begin(), names.end());
    for (JointMap& map : maps)
      if (!invert(map))
        throw ModelError(
            where +
            "only the parent has a free end, but this kind of joint needs one at the child: exchange <parent> "
            "and <child>");
  }
  add_chain(joint, maps, names, onto_child ? parent.node : child.node, onto_child ? child.node : parent.node,
            onto_child ? frame : Pose{meeting.position, frame.orientation});
  mechanism_.loop_joints.back().is_reversed = !onto_child;
}

void LoopBuilder::add_chain(const scene::JointDescription& joint, const std::vector<JointMap>& maps,
                            const std::vector<std::string>& names, int master, int slave, const Pose& frame) {
  const JointChain chain{&joint, static_cast<int>(model_.joints.size()), static_cast<int>(maps.size()) + 1, slave};
  int node = master;
  std::size_t name = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    JointMap map = maps[k];
    map.master = node;
    if (k == 0) place(map, mechanism_.pose_of(master).inverse() * frame);
    node = mechanism_.add_map(map, Released());
    const std::size_t count = released_count(map.kind);
    mechanism_.add_coordinates(joint, {names.begin() + name, names.begin() + name + count});
    name += count;
  }
  if (!names.empty() && names != coordinate_names(joint)) {
    // The chain is reversed, but coordinates keep the order of their names.
    const std::size_t first = model_.coordinates.size() - names.size();
    std::reverse(model_.coordinates.begin() + static_cast<std::ptrdiff_t>(first), model_.coordinates.end());
    for (std::size_t i = first; i < model_.coordinates.size(); ++i)
      model_.first_coordinate[model_.coordinates[i].joint] = static_cast<int>(i);
  }
  // Zero coordinates mean the initial configuration, so the slave keeps its initial pose relative to the chain.
  const Pose offset = mechanism_.pose_of(node).inverse() * mechanism_.pose_of(slave);
  JointMap rigid;
  rigid.master = node;
  rigid.slave = slave;
  rigid.origin.position = offset.position;
  rigid.slave_orientation = offset.orientation;
  mechanism_.slave_joint[slave] = static_cast<int>(model_.joints.size());
  mechanism_.append_joint(rigid, Released());
  mechanism_.loop_joints.push_back(chain);
}

/// Sorts elementary joints from the root to the leaves.
void sort_joints(Mechanism& mechanism) {
  Model& model = mechanism.model;
  std::vector<int>& slave_joint = mechanism.slave_joint;
  std::vector<int> order, place(model.joints.size(), -1);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    std::vector<int> stack = {static_cast<int>(j)};
    while (!stack.empty()) {
      const int next = stack.back();
      const std::size_t waiting = stack.size();
      if (place[next] < 0)
        for (const int master : masters(model, model.joints[next]))
          if (slave_joint[master] >= 0 && place[slave_joint[master]] < 0) stack.push_back(slave_joint[master]);
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
  for (int& joint : slave_joint)
    if (joint >= 0) joint = place[joint];
  permute(model.joints);
  permute(model.initial_released);
  permute(model.first_coordinate);
  for (JointMap& joint : model.joints)
    if (joint.leaving >= 0) joint.leaving = place[joint.leaving];
  for (Coordinate& coordinate : model.coordinates)
    if (!is_held(model, coordinate)) coordinate.joint = place[coordinate.joint];
  // A chain stays together, since only its own next joint is attached to a node inside it.
  for (auto* chains : {&mechanism.tree_joints, &mechanism.loop_joints})
    for (JointChain& chain : *chains)
      if (chain.map_count > 0) chain.first_map = place[chain.first_map];
}

/// Moves hidden coordinates behind the others, so that users count only those that they see.
void put_hidden_last(Mechanism& mechanism) {
  Model& model = mechanism.model;
  std::vector<bool> is_hidden(model.coordinates.size(), false);
  for (const auto* chains : {&mechanism.tree_joints, &mechanism.loop_joints})
    for (const JointChain& chain : *chains) {
      if (!chain.joint->is_hidden) continue;
      for (int j = chain.first_map; j < chain.first_map + chain.map_count; ++j)
        std::fill_n(is_hidden.begin() + model.first_coordinate[j], released_count(model.joints[j].kind), true);
    }
  std::vector<int> order(is_hidden.size()), place(is_hidden.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](int coordinate) { return !is_hidden[coordinate]; });
  const std::vector<Coordinate> before = model.coordinates;
  for (std::size_t i = 0; i < order.size(); ++i) {
    model.coordinates[i] = before[order[i]];
    place[order[i]] = static_cast<int>(i);
  }
  for (int& first : model.first_coordinate)
    if (first < static_cast<int>(place.size())) first = place[first];
  for (Coordinate& coordinate : model.coordinates)
    if (coordinate.mimicked >= 0) coordinate.mimicked = place[coordinate.mimicked];
  for (HeldJoint& held : model.held) held.coordinate = place[held.coordinate];
}

}  // namespace

ClosedMechanism close_loops(const ScenePlan& plan, TreeAtStart tree) {
  LoopBuilder loops(plan, tree);
  for (const scene::JointDescription& joint : plan.scene.loop_joints) loops.add(joint);
  if (!plan.scene.loop_joints.empty()) sort_joints(tree);
  put_hidden_last(tree);
  tree.model.length_scale = tree.extent();
  return {std::move(tree)};
}

}  // namespace flexarm
