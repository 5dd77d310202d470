#include "mechanism_builder.h"

#include <algorithm>
#include <cmath>

#include "initial_velocity.h"
#include "joints/joint_kinematics.h"
#include "math/shape_functions.h"
#include "math/so3.h"

namespace flexarm {
std::string MechanismBuilder::at(const scene::SourceLocation& location, const std::string& element) {
  return location.file + ":" + std::to_string(location.line) + ": " + element + ": ";
}

MechanismBuilder::MechanismBuilder(const scene::SceneDescription& scene)
    : meshes(scene.links.size()), scene_(scene), attachments_(scene.links.size()) {
  for (std::size_t i = 0; i < scene.links.size(); ++i)
    if (!link_indices_.emplace(scene.links[i].name, static_cast<int>(i)).second)
      throw ModelError(scene.file + ": two links are named '" + scene.links[i].name + "'");
  for (const scene::InitialJoint& initial : scene.initial_joints)
    initial_positions_[initial.coordinate] = initial.position;
  for (const scene::PrescribedMotion& motion : scene.motions)
    initial_positions_[motion.coordinate] = motion.position(0.0);
}

int MechanismBuilder::link_index(const std::string& name) const {
  const auto found = link_indices_.find(name);
  if (found == link_indices_.end()) throw ModelError(scene_.file + ": there is no link '" + name + "'");
  return found->second;
}

int MechanismBuilder::add_history(const TimeFunction& function) {
  model.histories.push_back(function);
  return static_cast<int>(model.histories.size()) - 1;
}

void MechanismBuilder::order_joints() {
  joints_below_.resize(scene_.links.size());
  joints_above_.resize(scene_.links.size(), nullptr);
  for (const scene::JointDescription& joint : scene_.joints) {
    const int child = link_index(joint.child);
    if (joints_above_[child])
      throw ModelError(at(joint.location, "<joint>") + "link '" + joint.child + "' has two parents");
    joints_above_[child] = &joint;
    joints_below_[link_index(joint.parent)].push_back(&joint);
  }
  // Depth first: nodes of a branch stand together, which keeps the matrix banded.
  std::vector<const scene::JointDescription*> stack;
  const auto push_children = [&](const std::string& link) {
    auto& list = joints_below_[link_index(link)];
    // What slides comes after the beams that are welded to the line.
    std::stable_partition(list.begin(), list.end(),
                          [](const scene::JointDescription* joint) { return joint->kind != scene::JointKind::Slide; });
    stack.insert(stack.end(), list.rbegin(), list.rend());
  };
  push_children(scene_.root_link);
  while (!stack.empty()) {
    const scene::JointDescription* joint = stack.back();
    stack.pop_back();
    ordered_joints_.push_back(joint);
    push_children(joint->child);
  }
  if (ordered_joints_.size() + 1 != scene_.links.size())
    throw ModelError(scene_.file + ": not every link is connected to the root link '" + scene_.root_link + "'");
}

void MechanismBuilder::build() {
  order_joints();
  for (const scene::LinkDescription& link : scene_.links) model.links.push_back({link.name, {}, std::nullopt});
  for (std::size_t i = 0; i < scene_.links.size(); ++i) {
    if (!scene_.links[i].beam) continue;
    const scene::BeamDescription& beam = *scene_.links[i].beam;
    try {
      meshes[i] = LinkMesh{Centreline(beam.centreline, beam.section_y), {}, -1};
    } catch (const std::invalid_argument& error) {
      throw ModelError(at(beam.location, "<centerline> of link '" + scene_.links[i].name + "'") + error.what());
    }
  }
  const auto attach = [&](const std::string& link, const Vector3& point) {
    const int index = link_index(link);
    if (meshes[index]) attachments_[index].push_back(meshes[index]->centreline.nearest(point));
  };
  for (const scene::JointDescription& joint : scene_.joints) attach(joint.parent, joint.origin.position);
  for (const scene::JointDescription& joint : scene_.loop_joints) {
    attach(joint.parent, joint.origin.position);
    attach(joint.child, joint.child_origin.position);
  }
  for (const scene::PointLoad& load : scene_.loads) attach(load.link, load.at);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (meshes[i]) meshes[i]->mesh = mesh_beam(*scene_.links[i].beam, meshes[i]->centreline, attachments_[i]);

  const int root = link_index(scene_.root_link);
  place_link(root, {-1, Pose()});
  for (const scene::JointDescription* joint : ordered_joints_) add_joint(*joint);
  place_bodies();
  int stiffness_point = 0, mass_point = 0, block = 0;
  for_each_element(model.beams, [&](auto& element) {
    using Element = std::decay_t<decltype(element)>;
    element.first_stiffness_point = stiffness_point;
    element.first_mass_point = mass_point;
    element.first_block = block;
    stiffness_point += Element::kStiffnessPoints;
    mass_point += Element::kMassPoints;
    block += Element::kNodes * Element::kNodes;
  });
  model.stiffness_point_count = stiffness_point;
  model.mass_point_count = mass_point;
  connect_mimics();
  close_loops();
  connect_coordinates();
  choose_constraints();
  InitialVelocity(scene_, *this).set();
}

// ---------------------------------------------------------------- nodes and maps

int MechanismBuilder::add_node(const Pose& pose, int parent) {
  NodePose node;
  node.position = pose.position;
  node.orientation = pose.orientation.normalized();
  node.rotation = node.orientation.toRotationMatrix();
  model.nodes.push_back(node);
  model.inertias.emplace_back();
  node_parents.push_back(parent);
  slave_joint_.push_back(-1);
  return static_cast<int>(model.nodes.size()) - 1;
}

Pose MechanismBuilder::pose_of(int node) const {
  return node < 0 ? Pose() : Pose{model.nodes[node].position, model.nodes[node].orientation};
}

int MechanismBuilder::add_map(JointMap map, const Released& released) {
  const int joint = static_cast<int>(model.joints.size());
  model.joints.push_back(map);
  const NodePose slave = slave_pose(model, joint, model.nodes, released);
  map.slave = model.joints[joint].slave = add_node({slave.position, slave.orientation}, map.master);
  model.initial_released.push_back(released);
  model.first_coordinate.push_back(static_cast<int>(model.coordinates.size()));
  slave_joint_[map.slave] = joint;
  return map.slave;
}

int MechanismBuilder::add_rigid(int master, const Pose& offset) {
  JointMap map;
  map.master = master;
  map.origin.position = offset.position;
  map.slave_orientation = offset.orientation;
  return add_map(map, Released());
}

Attachment MechanismBuilder::attachment(const std::string& link, const Vector3& point) const {
  const int index = link_index(link);
  const LinkFrame& frame = model.links[index];
  if (!meshes[index]) return frame.frame;
  const int node = meshes[index]->mesh.node_at(meshes[index]->centreline.nearest(point));
  return {meshes[index]->first_node + node, meshes[index]->mesh.nodes[node].pose.inverse()};
}

void MechanismBuilder::add_joint(const scene::JointDescription& joint) {
  const int child = link_index(joint.child);
  JointRecord record{&joint, static_cast<int>(model.joints.size()), 0};
  const bool slides = joint.kind == scene::JointKind::Slide;
  const Attachment parent = slides ? add_slide(joint) : attachment(joint.parent, joint.origin.position);
  const Pose origin = slides ? parent.offset : parent.offset * joint.origin;
  const scene::JointKind rotation = slides ? joint.slide->rotation : joint.kind;
  const int slide = slides ? record.first_map : -1;
  const bool leaves = slides && joint.slide->on_end == scene::SlideDescription::End::Free;
  if (rotation == scene::JointKind::Fixed) {
    record.map_count = slides ? 1 : 0;
    // What leaves the line needs a node of its own.
    place_link(child, leaves ? Attachment{add_rigid(parent.node, origin), Pose()} : Attachment{parent.node, origin});
    if (leaves) model.joints[slide].leaving = slide + 1;
  } else {
    // The child's first mesh node is the slave itself where its section lies in the link origin.
    const bool direct = meshes[child] && meshes[child]->mesh.centroid.isZero(0);
    scene::JointDescription released = joint;
    released.kind = rotation;
    if (slides) {
      released.limits.reset();
      released.direction = joint.origin.orientation.conjugate() * Vector3::UnitX();  // of the line
    }
    std::vector<JointMap> maps = elementary_joints(released);
    int node = parent.node;
    const std::vector<std::string>& suffixes = scene::coordinate_suffixes(joint);
    std::size_t suffix = slides ? 1 : 0;
    for (std::size_t k = 0; k < maps.size(); ++k) {
      JointMap& map = maps[k];
      map.master = node;
      if (k == 0) map.origin = origin * map.origin;
      if (k + 1 == maps.size() && direct) map.slave_orientation = meshes[child]->mesh.nodes[0].pose.orientation;
      std::vector<std::string> names;
      for (int c = 0; c < released_count(map.kind); ++c) names.push_back(joint.name + suffixes[suffix++]);
      node = add_map(map, initial_released(map, names));
      add_coordinates(released, names);
    }
    if (slides && scene::has_dependent_travel(rotation)) couple_slide(released);
    if (leaves) model.joints[slide].leaving = static_cast<int>(model.joints.size()) - 1;
    record.map_count = static_cast<int>(maps.size()) + (slides ? 1 : 0);
    if (direct)
      place_beam(child, node);
    else
      place_link(child, {node, Pose()});
  }
  records_.push_back(record);
}

void MechanismBuilder::place_link(int link, const Attachment& base) {
  const scene::LinkDescription& description = scene_.links[link];
  if (meshes[link]) {
    place_beam(link, add_rigid(base.node, base.offset * meshes[link]->mesh.nodes[0].pose));
    return;
  }
  model.links[link].frame = base;
  if (description.inertial && base.node >= 0) {
    const scene::RigidInertia& inertial = *description.inertial;
    const Matrix3 rotation = base.offset.orientation.toRotationMatrix();
    Body& body = bodies_[base.node];
    body.add(inertial.mass, base.offset * inertial.center_of_mass, rotation * inertial.inertia * rotation.transpose());
  }
}

void MechanismBuilder::place_beam(int link, int first_node) {
  LinkMesh& mesh = *meshes[link];
  mesh.first_node = first_node;
  const Pose origin = pose_of(first_node) * mesh.mesh.nodes[0].pose.inverse();
  for (std::size_t i = 1; i < mesh.mesh.nodes.size(); ++i) {
    const MeshNode& node = mesh.mesh.nodes[i];
    if (node.welded_to >= 0)
      add_rigid(first_node + node.welded_to, mesh.mesh.nodes[node.welded_to].pose.inverse() * node.pose);
    else
      add_node(origin * node.pose, first_node);
  }

  const scene::BeamDescription& description = *scene_.links[link].beam;
  BeamLink beam;
  beam.order = description.order;
  beam.centroid = mesh.mesh.centroid;
  const MeshNode& last = mesh.mesh.nodes.back();
  beam.tip = {first_node + static_cast<int>(mesh.mesh.nodes.size()) - 1,
              Pose{-mesh.mesh.centroid, last.pose.orientation.conjugate()}};
  beam.length = mesh.centreline.length();
  beam.mass = beam.length * mesh.mesh.section.mass;
  beam.radius = mesh.mesh.section.radius;
  model.links[link].beam = beam;
  model.links[link].frame = {first_node, mesh.mesh.nodes[0].pose.inverse()};
  switch (description.order) {
    case 1:
      add_elements<2>(link);
      break;
    case 2:
      add_elements<3>(link);
      break;
    case 3:
      add_elements<4>(link);
      break;
    case 4:
      add_elements<5>(link);
      break;
    default:
      throw ModelError(at(description.location, "<beam>") + "order must be 1 to 4");
  }
}

template <int Nodes>
void MechanismBuilder::add_elements(int link) {
  const LinkMesh& mesh = *meshes[link];
  const scene::BeamDescription& description = *scene_.links[link].beam;
  std::vector<BeamElement<Nodes>>& group = std::get<BeamGroup<Nodes>>(model.beams).elements;
  BeamLink& beam = *model.links[link].beam;
  for (const MeshElement& element : mesh.mesh.elements) {
    BeamElement<Nodes> out = beam_element<Nodes>(mesh.mesh, element, description);
    NodalValues<Nodes> weights = NodalValues<Nodes>::Zero();
    for (const auto& point : out.mass_points) weights += point.weight * point.shape;
    for (int i = 0; i < Nodes; ++i) {
      out.nodes[i] = mesh.first_node + element.nodes[i];
      NodalInertia& inertia = model.inertias[out.nodes[i]];
      inertia.total_mass += out.mass.row(i).sum();
      inertia.beam_rotary += weights[i] * out.inertia;
      inertia.rotary_damping += out.mass_damping * weights[i] * out.inertia;
    }
    beam.elements.push_back(static_cast<int>(group.size()));
    beam.element_ends.push_back(element.end);
    group.push_back(out);
  }
}

std::vector<double> MechanismBuilder::length_weights(int link) const {
  const LinkMesh& mesh = *meshes[link];
  std::vector<double> weights(mesh.mesh.nodes.size(), 0.0);
  const BeamLink& beam = *model.links[link].beam;
  for_each_group(model.beams, [&](const auto& group) {
    using Element = typename std::decay_t<decltype(group.elements)>::value_type;
    if (Element::kNodes != beam.order + 1) return;
    for (const int e : beam.elements) {
      const Element& element = group.elements[e];
      for (const auto& point : element.mass_points)
        for (int i = 0; i < Element::kNodes; ++i)
          weights[element.nodes[i] - mesh.first_node] += point.weight * point.shape[i];
    }
  });
  return weights;
}

void MechanismBuilder::Body::add(double m, const Vector3& center, const Matrix3& about_center) {
  const Vector3 joint_center = mass + m > 0 ? Vector3((mass * this->center + m * center) / (mass + m)) : center;
  const auto shifted = [&](double mi, const Vector3& ci, const Matrix3& ji) {
    const Matrix3 d = so3::hat(Vector3(ci - joint_center));
    return Matrix3(ji - mi * d * d);
  };
  inertia = shifted(mass, this->center, inertia) + shifted(m, center, about_center);
  mass += m;
  this->center = joint_center;
}

void MechanismBuilder::place_bodies() {
  for (const auto& [node, body] : bodies_) {
    const bool centred = body.center.norm() < 1e-15;
    const int at = centred ? node : add_rigid(node, {body.center, Quaternion::Identity()});
    NodalInertia& inertia = model.inertias[at];
    inertia.mass += body.mass;
    inertia.total_mass += body.mass;
    inertia.rotary += body.inertia;
  }
}

}  // namespace flexarm
