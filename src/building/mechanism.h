#pragma once
/// A mechanism under construction, and the stages through which the passes of build_model() take it (internal to
/// building/).

#include <string>
#include <vector>

#include "building/scene_plan.h"
#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// A joint of the scene, and the chain of elementary joints of which it consists.
struct JointChain {
  const scene::JointDescription* joint;
  int first_map, map_count;  ///< into Model::joints
  int closed_node = -1;      ///< if the joint closes a loop: the beam's node that its last map moves
  bool is_reversed = false;  ///< if the joint closes a loop: that node is on its parent
};

struct Mechanism {
  Model model;
  std::vector<int> node_parents;  ///< node that a node moves with when the joints outboard move; -1: world
  std::vector<int> slave_joint;   ///< per node: joint of which it is the slave, or -1
  std::vector<JointChain> tree_joints, loop_joints;  ///< root to leaf
  double contact_time = 0;                           ///< of stops that say nothing else [s]

  /// Pose of a node, or of the world (-1) [m].
  Pose pose_of(int node) const;
  /// Size of the mechanism at the start [m]; 1 if that is zero.
  double extent() const;

  /// Reserves memory for `count` more nodes.
  void reserve_nodes(std::size_t count);
  int add_node(const Pose& pose, int parent);
  /// Adds an elementary joint with its slave node; returns the node.
  int add_map(JointMap map, const Released& released);
  int add_rigid(int master, const Pose& offset);
  /// Adds an elementary joint between existing nodes, in front of the held ones, whose indices grow by one.
  void append_joint(const JointMap& map, const Released& released);
  /// Adds an elementary joint that is held; returns its index.
  int append_held_joint(const JointMap& map, const Released& released);
  /// Moves nodes inside the rigid bodies that they carry, by `ways` in their frames [m]. Only for nodes that a joint
  /// places, and to which nothing but joints and frames of rigid links refers.
  void move_nodes(const std::vector<Vector3>& ways);
  /// Adds the coordinates of the elementary joint that was added last.
  void add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names) {
    add_coordinates(joint, names, static_cast<int>(model.joints.size()) - 1);
  }
  /// Adds the coordinates of an elementary joint.
  void add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names, int map);
};

// Each stage has everything that the earlier stages have. So the compiler checks that a pass is called after the passes
// that it needs.
struct PlacedTree : Mechanism {};         ///< nodes, elementary joints and coordinates of the tree
struct MassiveTree : Mechanism {};        ///< elements of beams, rigid bodies
struct TreeAtStart : Mechanism {};        ///< poses at the start, those of mimicking coordinates included
struct ClosedMechanism : Mechanism {};    ///< joints and constraints that close loops; all nodes
struct DrivenMechanism : Mechanism {};    ///< motions and efforts
struct SolvableMechanism : Mechanism {};  ///< only independent constraints

/// For a point of a link (link frame): the node of the nearest cross-section, and the link frame relative to that node.
Attachment attachment(const ScenePlan& plan, const Model& model, const std::string& link, const Vector3& point);

}  // namespace flexarm
