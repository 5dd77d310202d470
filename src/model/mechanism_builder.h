#pragma once
/// Nodes, elements, joints, coordinates and initial motion from a scene (internal to model/).

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/beam_mesh.h"
#include "model/centreline.h"
#include "model/model.h"
#include "model/model_builder.h"

namespace flexarm {

/// The chain of elementary joints that makes up a joint; without the travel of one that is coupled to a slide.
std::vector<JointMap> elementary_joints(const scene::JointDescription& joint);

class MechanismBuilder {
 public:
  struct LinkMesh {
    Centreline centreline;
    BeamMesh mesh;
    int first_node;  ///< mesh node i is node first_node + i of the model
  };

  /// A joint of the scene and its elementary maps. Those that close loops come last.
  struct JointRecord {
    const scene::JointDescription* joint;
    int first_map, map_count;
    int closed_node = -1;  ///< of a loop joint: the beam's node that its last map moves
  };

  explicit MechanismBuilder(const scene::SceneDescription& scene);
  void build();

  int link_index(const std::string& name) const;
  /// Node and link frame seen from it, for a point of the link (link frame): the nearest cross-section's node.
  Attachment attachment(const std::string& link, const Vector3& point) const;
  /// int I^i ds of the nodes of a flexible link [m].
  std::vector<double> length_weights(int link) const;
  int add_history(const TimeFunction& function);
  Pose pose_of(int node) const;
  /// Of the mechanism as it starts [m].
  double extent() const;
  const std::vector<JointRecord>& records() const { return records_; }  ///< root to leaf
  /// "file:line: element: "
  static std::string at(const scene::SourceLocation& location, const std::string& element);

  Model model;
  std::vector<std::optional<LinkMesh>> meshes;  ///< per link
  std::vector<int> node_parents;  ///< node that a node moves with when the joints outboard move; -1: world

 private:
  /// Rigid bodies carried by one node, in its frame.
  struct Body {
    double mass = 0;
    Vector3 center = Vector3::Zero();
    Matrix3 inertia = Matrix3::Zero();  ///< about the centre
    void add(double mass, const Vector3& center, const Matrix3& inertia_about_center);
  };

  void order_joints();
  void add_joint(const scene::JointDescription& joint);
  void place_link(int link, const Attachment& base);
  void place_beam(int link, int first_node);
  template <int Nodes>
  void add_elements(int link);
  void place_bodies();
  int add_node(const Pose& pose, int parent);
  /// Adds an elementary joint with its slave node; returns the node.
  int add_map(JointMap map, const Released& released);
  int add_rigid(int master, const Pose& offset);
  /// Adds the section that slides along the parent's line; what the joint moves hangs on it.
  Attachment add_slide(const scene::JointDescription& joint);
  /// Lets the arc length of the slide made last follow the angle of its joint, both added last.
  void couple_slide(const scene::JointDescription& joint);
  /// The smooth stretch that contains where a slide on a flexible link starts, over beams welded to it; made once.
  /// Arc lengths count from the link's origin, and are negative before it.
  int slide_line(int link, const scene::SlideDescription& slide);
  int add_line(const SlideLine& line);
  /// True where the section of node `after` is that of node `before` in place and direction.
  bool continues(int before, int after) const;
  /// The links whose beams are fixed tip to origin without a kink, one of them `link`, in order.
  std::vector<int> welded_beams(int link) const;
  int last_node(int link) const { return model.links[link].beam->tip.node; }

  /// Adds the joints that close loops of the tree, which stands as it starts, and sorts all of them root to leaf.
  void close_loops();
  /// `largest_gap`: between the joint's frames at the start [m].
  void add_loop(const scene::JointDescription& joint, double largest_gap);
  /// Of the child's place. Where a flexible link is joined to itself at the beginning of a closed line, that is its
  /// end.
  Attachment loop_child(const scene::JointDescription& joint) const;
  /// From `master` through `maps`, the first at `frame` (world), to the existing node `slave`.
  void chain_loop(const scene::JointDescription& joint, const std::vector<JointMap>& maps,
                  const std::vector<std::string>& names, int master, int slave, const Pose& frame);
  /// Where no node is free: constraints with multipliers, at `frame` (world).
  void add_closure(const scene::JointDescription& joint, Attachment parent, Attachment child, const Pose& frame);
  /// Of the closures' constraints those that are independent, by pivoting at the start; the others are implied.
  void choose_constraints();
  void sort_joints();
  /// The same frame, seen from the node at the root of the rigid body to which it is fixed.
  Attachment carrier(Attachment frame) const;
  /// The node is free, and `master` does not follow from it.
  bool can_become_slave(int node, int master) const;

  void add_coordinates(const scene::JointDescription& joint, const std::vector<std::string>& names);
  Released initial_released(const JointMap& map, const std::vector<std::string>& names) const;
  /// What the scene gives, else `otherwise`.
  double initial_position(const std::string& coordinate, double otherwise = 0) const;
  /// Lets coordinates be found by name; to be called when others have been added.
  void index_coordinates();
  int coordinate_index(const std::string& name, const std::string& where) const;
  void connect_mimics();
  void connect_coordinates();
  void update_initial_poses();

  const scene::SceneDescription& scene_;
  std::map<std::string, int> link_indices_;
  std::vector<int> slave_joint_;                                // per node: the joint of which it is the slave, or -1
  std::unordered_map<std::string, double> initial_positions_;   // by coordinate, where the scene gives them
  std::unordered_map<std::string, int> coordinate_indices_;     // by name
  std::vector<const scene::JointDescription*> ordered_joints_;  // root to leaf
  std::vector<const scene::JointDescription*> joints_above_;    // per link; null above the root
  std::vector<std::vector<const scene::JointDescription*>> joints_below_;  // per link, in the order of building
  std::vector<std::vector<double>> attachments_;                           // per link: arc lengths of element borders
  std::vector<JointRecord> records_;                                       // root to leaf
  std::map<int, Body> bodies_;                                             // by node
};

}  // namespace flexarm
