#include "building/passes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "building/rigid_body.h"
#include "math/shape_functions.h"

namespace flexarm {
namespace {

/// The root link, then the children of the joints, from the root to the leaves.
std::vector<int> links_root_to_leaf(const ScenePlan& plan) {
  std::vector<int> links = {plan.tree.root};
  for (const scene::JointDescription* joint : plan.tree.joints) links.push_back(plan.links[joint->child]);
  return links;
}

/// Adds a beam's prestrain. Returns its index, or -1 if the beam has none.
int add_prestrain(const scene::BeamDescription& beam, const Vector3& centroid, Model& model) {
  Prestrain out;
  out.centroid = centroid;
  bool is_given = false;
  for (std::size_t i = 0; i < beam.prestrain.size(); ++i) {
    if (!beam.prestrain[i]) continue;
    is_given = true;
    out.histories[i] = static_cast<int>(model.histories.size());
    model.histories.push_back(*beam.prestrain[i]);
  }
  if (!is_given) return -1;
  model.prestrains.push_back(out);
  return static_cast<int>(model.prestrains.size()) - 1;
}

template <int Nodes>
void add_elements(const ScenePlan& plan, int link, Model& model) {
  const BeamMesh& mesh = plan.meshes[link]->mesh;
  const int first_node = model.links[link].frame.node;
  std::vector<BeamElement<Nodes>>& group = std::get<BeamGroup<Nodes>>(model.beams).elements;
  BeamLink& beam = *model.links[link].beam;
  const scene::BeamDescription& description = *plan.scene.links[link].beam;
  const int prestrain = add_prestrain(description, mesh.centroid, model);
  for (const MeshElement& element : mesh.elements) {
    BeamElement<Nodes> out = beam_element<Nodes>(mesh, element, description);
    out.prestrain = prestrain;
    for (int i = 0; i < Nodes; ++i) {
      out.nodes[i] = first_node + element.nodes[i];
      NodalInertia& inertia = model.inertias[out.nodes[i]];
      inertia.total_mass += out.mass.row(i).sum();
      for (const auto& point : out.mass_points) {
        const Matrix3 rotary = point.weight * point.shape[i] * point.inertia;
        inertia.beam_rotary += rotary;
        inertia.rotary_damping += out.mass_damping * rotary;
      }
    }
    beam.mass += out.mass.sum();
    beam.elements.push_back(static_cast<int>(group.size()));
    beam.element_ends.push_back(element.end);
    beam.parts.push_back(element.part);
    group.push_back(out);
  }
}

/// Reserves memory for all elements at once, since growth by doubling would take twice the memory in a large scene.
template <int Nodes>
void reserve_elements(const ScenePlan& plan, std::vector<BeamElement<Nodes>>& elements) {
  std::size_t count = 0;
  for (const auto& link : plan.meshes)
    if (link && link->mesh.order + 1 == Nodes) count += link->mesh.elements.size();
  elements.reserve(count);
}

void add_beams(const ScenePlan& plan, Model& model) {
  for_each_group(model.beams, [&](auto& group) { reserve_elements(plan, group.elements); });
  for (const int link : links_root_to_leaf(plan))
    if (plan.meshes[link])
      for_each_group(model.beams, [&](const auto& group) {
        constexpr int kNodes = std::decay_t<decltype(group)>::kNodes;
        if (plan.meshes[link]->mesh.order + 1 == kNodes) add_elements<kNodes>(plan, link, model);
      });
  int stiffness_point = 0, mass_point = 0, block = 0;
  for_each_element(model.beams, [&](auto& element) {
    using Element = std::decay_t<decltype(element)>;
    element.first_stiffness_point = stiffness_point;
    element.first_mass_point = mass_point;
    element.first_block = block;
    stiffness_point += Element::kStiffnessPoints;
    mass_point += Element::kMassPoints;
    block += Element::kNodes * Element::kNodes;
    model.maxwell_branches = std::max(model.maxwell_branches, static_cast<int>(element.maxwell.size()));
  });
  model.stiffness_point_count = stiffness_point;
  model.mass_point_count = mass_point;
}

/// Per node: whether a joint alone determines its place, and no beam or line, so that it may be moved inside its rigid
/// body.
std::vector<bool> movable_nodes(const Mechanism& mechanism) {
  std::vector<bool> is_movable(mechanism.model.nodes.size(), false);
  for (const JointMap& joint : mechanism.model.joints) is_movable[joint.slave] = joint.kind != JointMapKind::Slide;
  for_each_element(mechanism.model.beams, [&](const auto& element) {
    for (const int node : element.nodes) is_movable[node] = false;
  });
  return is_movable;
}

/// Adds the hubs at the ends of beams.
void add_hubs(const ScenePlan& plan, const Model& model, std::map<int, RigidBody>& bodies) {
  for (std::size_t link = 0; link < plan.scene.links.size(); ++link) {
    if (!plan.meshes[link]) continue;
    const BeamMesh& mesh = plan.meshes[link]->mesh;
    for (const scene::HubDescription& hub : plan.scene.links[link].beam->hubs) {
      const std::size_t end = hub.end == scene::HubDescription::End::Start ? 0 : mesh.nodes.size() - 1;
      const Matrix3 section = mesh.nodes[end].pose.orientation.toRotationMatrix();
      bodies[model.links[link].frame.node + static_cast<int>(end)] +=
          {hub.mass, -mesh.centroid, section.transpose() * hub.inertia.asDiagonal() * section};
    }
  }
}

void add_bodies(const ScenePlan& plan, Mechanism& mechanism) {
  std::map<int, RigidBody> bodies;  // by node
  for (const int link : links_root_to_leaf(plan)) {
    const std::optional<scene::RigidInertia>& inertial = plan.scene.links[link].inertial;
    const Attachment& frame = mechanism.model.links[link].frame;
    if (plan.meshes[link] || !inertial || frame.node < 0) continue;
    bodies[frame.node] += body_of(*inertial, frame.offset);
  }
  add_hubs(plan, mechanism.model, bodies);
  // Move a joint's slave to the centre of mass of its body: then a rigid link has one node and one joint.
  const std::vector<bool> is_movable = movable_nodes(mechanism);
  std::vector<Vector3> ways(is_movable.size(), Vector3::Zero());
  for (auto& [node, body] : bodies)
    if (is_movable[node]) std::swap(ways[node], body.center);
  mechanism.move_nodes(ways);
  for (const auto& [node, body] : bodies) {
    const bool centred = body.center.norm() < 1e-15;
    const int at = centred ? node : mechanism.add_rigid(node, {body.center, Quaternion::Identity()});
    NodalInertia& inertia = mechanism.model.inertias[at];
    inertia.mass += body.mass;
    inertia.total_mass += body.mass;
    inertia.rotary += body.inertia;
  }
}

}  // namespace

MassiveTree add_inertia(const ScenePlan& plan, PlacedTree tree) {
  add_beams(plan, tree.model);
  add_bodies(plan, tree);
  return {std::move(tree)};
}

std::vector<double> length_weights(const ScenePlan& plan, const Model& model, int link, double from, double to) {
  const LinkFrame& frame = model.links[link];
  std::vector<double> weights(plan.meshes[link]->mesh.nodes.size(), 0.0);
  for_each_group(model.beams, [&](const auto& group) {
    constexpr int kNodes = std::decay_t<decltype(group)>::kNodes;
    if (kNodes != frame.beam->order + 1) return;
    for (std::size_t k = 0; k < frame.beam->elements.size(); ++k) {
      const double begin = k == 0 ? 0.0 : frame.beam->element_ends[k - 1], end = frame.beam->element_ends[k];
      if (0.5 * (begin + end) < from || 0.5 * (begin + end) > to) continue;
      const auto& element = group.elements[frame.beam->elements[k]];
      for (const auto& point : element.mass_points)
        for (int i = 0; i < kNodes; ++i) weights[element.nodes[i] - frame.frame.node] += point.weight * point.shape[i];
    }
  });
  return weights;
}

}  // namespace flexarm
