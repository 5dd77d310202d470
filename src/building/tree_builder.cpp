#include "building/passes.h"

#include "building/elementary_joints.h"
#include "building/slide_builder.h"
#include "joints/joint_map.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Initial values of the coordinates with these names, which belong to one elementary joint.
Released initial_released(JointMapKind kind, const std::vector<std::string>& names, const InitialPositions& positions) {
  Released out;
  std::vector<double> values;
  values.reserve(names.size());
  for (const std::string& name : names) values.push_back(positions.of(name));
  if (kind == JointMapKind::Scalar || kind == JointMapKind::Slide) {
    out.displacement[0] = values[0];
  } else if (kind != JointMapKind::Rigid) {
    if (kind == JointMapKind::Free) out.displacement = Vector3(values[0], values[1], values[2]);
    const std::size_t n = values.size();
    out.rotation = so3::exp_quaternion(Vector3(values[n - 3], values[n - 2], values[n - 1]));
  }
  return out;
}

class TreeBuilder {
 public:
  explicit TreeBuilder(const ScenePlan& plan) : plan_(plan), model_(tree_.model), slides_(plan, tree_) {}

  PlacedTree build() {
    for (const scene::LinkDescription& link : plan_.scene.links) model_.links.push_back({link.name, {}, std::nullopt});
    model_.origin = plan_.origin;
    model_.floats = plan_.floats;
    model_.initial_origin = plan_.start_origin;
    // Room for the nodes of beams, and for two nodes per joint; joints may add more.
    std::size_t count = 0;
    for (const std::optional<LinkMesh>& link : plan_.meshes)
      if (link) count += link->mesh.nodes.size();
    tree_.reserve_nodes(count + 2 * plan_.tree.joints.size());
    tree_.contact_time = plan_.scene.contact_time;
    place_link(plan_.tree.root, {-1, Pose{Vector3::Zero() - plan_.origin, Quaternion::Identity()}});
    for (const scene::JointDescription* joint : plan_.tree.joints)
      tree_.tree_joints.push_back(joint->kind == scene::JointKind::Slide ? add_slide(*joint) : add_joint(*joint));
    return std::move(tree_);
  }

 private:
  JointChain add_joint(const scene::JointDescription& joint) {
    const int first = next_map(), child = plan_.links[joint.child];
    Attachment frame = attachment(plan_, model_, joint.parent, joint.origin.position);
    frame.offset = frame.offset * joint.origin;
    if (joint.kind == scene::JointKind::Fixed) {
      // For links that were attached beside the line of a beam.
      const Pose& on_child = joint.child_origin;
      if (!on_child.position.isZero(0) || !on_child.orientation.vec().isZero(0))
        frame.offset = frame.offset * on_child.inverse();
      // A link whose reaction is measured needs a node of its own.
      if (!plan_.meshes[child] && measures_reaction(plan_.scene, joint.child))
        frame = {tree_.add_rigid(frame.node, frame.offset), Pose()};
      place_link(child, frame);
      return {&joint, first, 0};
    }
    if (const auto held = plan_.held.find(joint.name); held != plan_.held.end()) {
      place_link(child, add_held(joint, held->second, frame));
      return {&joint, first, 0};
    }
    const int node = add_maps(joint, coordinate_names(joint), frame);
    const int end = next_map();
    place_child(child, node);
    return {&joint, first, end - first};
  }

  /// Adds a joint that is held at `position`. Returns the frame of its child, as for a fixed joint.
  Attachment add_held(const scene::JointDescription& joint, double position, const Attachment& frame) {
    JointMap map = elementary_joints(joint).front();
    place(map, frame.offset);
    Released released;
    released.displacement[0] = position;
    const NodePose child = slave_pose(map, NodePose(), released);
    map.master = map.slave = frame.node;
    map.slave_orientation = so3::exp_quaternion(Vector3(-position * map.rotation));
    map.arm = -child.position;
    tree_.model.held.emplace_back().coordinate = static_cast<int>(model_.coordinates.size());
    tree_.add_coordinates(joint, coordinate_names(joint), tree_.append_held_joint(map, released));
    return {frame.node, Pose{child.position, child.orientation}};
  }

  /// Adds a section that slides, and the joint of its rotation.
  JointChain add_slide(const scene::JointDescription& joint) {
    const int slide = next_map(), child = plan_.links[joint.child];
    Attachment frame = slides_.add(joint);
    const bool leaves = joint.slide->on_end == scene::SlideDescription::End::Free;
    scene::JointDescription released = joint;
    released.kind = joint.slide->rotation;
    if (released.kind == scene::JointKind::Fixed) {
      // A link that leaves the line needs a node of its own.
      if (leaves) {
        model_.joints[slide].leaving = slide + 1;
        frame = {tree_.add_rigid(frame.node, frame.offset), Pose()};
      }
      place_link(child, frame);
      return {&joint, slide, 1};
    }
    released.limits.reset();
    released.direction = joint.origin.orientation.conjugate() * Vector3::UnitX();  // direction of the line
    std::vector<std::string> names = coordinate_names(joint);
    names.erase(names.begin());  // the slide's own
    const int node = add_maps(released, names, frame);
    if (scene::has_dependent_travel(released.kind)) slides_.couple(released);
    const int end = next_map();
    if (leaves) model_.joints[slide].leaving = end - 1;
    place_child(child, node);
    return {&joint, slide, end - slide};
  }

  /// Adds the chain of a joint whose coordinates have these names. Returns its last node, which moves the child.
  int add_maps(const scene::JointDescription& joint, const std::vector<std::string>& names, const Attachment& frame) {
    const std::optional<LinkMesh>& child = plan_.meshes[plan_.links[joint.child]];
    std::vector<JointMap> maps = elementary_joints(joint);
    if (child) {
      const Pose& first_node = child->mesh.nodes[0].pose;
      maps.back().slave_orientation = first_node.orientation;
      maps.back().arm = first_node.orientation.conjugate() * first_node.position;
    }
    place(maps.front(), frame.offset);
    int node = frame.node;
    auto name = names.begin();
    for (JointMap& map : maps) {
      map.master = node;
      const std::vector<std::string> own(name, name + released_count(map.kind));
      name += released_count(map.kind);
      Released start = initial_released(map.kind, own, plan_.initial_positions);
      if (node < 0) start.displacement -= map.origin.orientation.conjugate() * plan_.start_origin;
      node = tree_.add_map(map, start);
      tree_.add_coordinates(joint, own);
    }
    return node;
  }

  /// Places a link at the last node of its joint: as the first node of a beam, or as the frame of a rigid link.
  void place_child(int link, int node) {
    if (plan_.meshes[link])
      place_beam(link, node);
    else
      model_.links[link].frame = {node, Pose()};
  }

  void place_link(int link, const Attachment& base) {
    if (plan_.meshes[link])
      place_beam(link, tree_.add_rigid(base.node, base.offset * plan_.meshes[link]->mesh.nodes[0].pose));
    else
      model_.links[link].frame = base;
  }

  void place_beam(int link, int first_node) {
    const auto& [centreline, mesh] = *plan_.meshes[link];
    const Pose origin = tree_.pose_of(first_node) * mesh.nodes[0].pose.inverse();
    for (std::size_t i = 1; i < mesh.nodes.size(); ++i) {
      const MeshNode& node = mesh.nodes[i];
      if (node.welded_to >= 0)
        tree_.add_rigid(first_node + node.welded_to, mesh.nodes[node.welded_to].pose.inverse() * node.pose);
      else
        tree_.add_node(origin * node.pose, first_node);
    }
    BeamLink beam;
    beam.order = mesh.order;
    beam.centroid = mesh.centroid;
    beam.tip = {first_node + static_cast<int>(mesh.nodes.size()) - 1,
                Pose{-mesh.centroid, mesh.nodes.back().pose.orientation.conjugate()}};
    beam.length = centreline.length();
    beam.radius = mesh.section.largest_radius();
    beam.refines = plan_.scene.links[link].beam->refine.value_or(false);
    model_.links[link].beam = beam;
    model_.links[link].frame = {first_node, mesh.nodes[0].pose.inverse()};
  }

  int next_map() const { return static_cast<int>(model_.joints.size()); }

  const ScenePlan& plan_;
  PlacedTree tree_;
  Model& model_;
  SlideBuilder slides_;
};

}  // namespace

PlacedTree place_tree(const ScenePlan& plan) {
  return TreeBuilder(plan).build();
}

}  // namespace flexarm
