#include "simulation/model_correspondence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

namespace flexarm {
namespace {

/// Two poses in a body are the same if they differ by less than this: positions over the model's length scale,
/// orientations in the coefficients of their quaternions.
constexpr double kSamePlace = 1e-14;

bool is_same_place(const Pose& a, const Pose& b, double length) {
  return (a.position - b.position).norm() <= kSamePlace * length &&
         a.orientation.angularDistance(b.orientation) <= 1e-7 &&
         (a.orientation.coeffs() - b.orientation.coeffs()).norm() <= kSamePlace;
}

/// For each item of `after`, the index of the item with the same name in `before`, or -1.
template <class Things>
std::vector<int> same_names(const Things& before, const Things& after) {
  std::map<std::string, int> indices;
  for (std::size_t i = 0; i < before.size(); ++i) indices.emplace(before[i].name, static_cast<int>(i));
  std::vector<int> out;
  for (const auto& thing : after) {
    const auto found = indices.find(thing.name);
    out.push_back(found == indices.end() ? -1 : found->second);
  }
  return out;
}

}  // namespace

ModelCorrespondence::ModelCorrespondence(const ModelOfScene& before, const ModelOfScene& after)
    : links(same_names(before.model.links, after.model.links)),
      coordinates(same_names(before.model.coordinates, after.model.coordinates)),
      sensors(same_names(before.scene.sensors, after.scene.sensors)),
      nodes(after.model.nodes.size(), -1),
      stiffness_points(after.model.stiffness_point_count, -1),
      mass_points(after.model.mass_point_count, -1) {
  find_nodes(before.model, after.model);
  find_points(before.model, after.model);
}

void ModelCorrespondence::find_nodes(const Model& before, const Model& after) {
  // Nodes of rigid links. Only the frame of the link decides what such a node corresponds to.
  std::vector<bool> is_body(after.nodes.size(), false);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const LinkFrame& now = after.links[i];
    if (!now.beam && now.frame.node >= 0) is_body[now.frame.node] = true;
    if (links[i] < 0 || now.frame.node < 0) continue;
    const LinkFrame& then = before.links[links[i]];
    if (now.beam)
      for (int k = 0; now.frame.node + k <= now.beam->tip.node; ++k) nodes[now.frame.node + k] = then.frame.node + k;
    else if (then.frame.node >= 0 && nodes[now.frame.node] < 0 &&
             is_same_place(now.frame.offset, then.frame.offset, after.length_scale))
      nodes[now.frame.node] = then.frame.node;
  }
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const int joint = after.coordinates[c].joint;
    if (coordinates[c] < 0 || after.joints.is_held(joint)) continue;
    const int then = before.coordinates[coordinates[c]].joint, slave = after.joints[joint].slave;
    if (!before.joints.is_held(then) && nodes[slave] < 0 && !is_body[slave]) nodes[slave] = before.joints[then].slave;
  }
  for (const JointMap& joint : after.joints) {
    if (joint.kind != JointMapKind::Rigid || nodes[joint.slave] >= 0 || is_body[joint.slave]) continue;
    const int master = joint.master < 0 ? -1 : nodes[joint.master];
    if (joint.master >= 0 && master < 0) continue;
    for (const JointMap& then : before.joints)
      if (then.kind == JointMapKind::Rigid && then.master == master &&
          is_same_place({joint.origin.position, joint.slave_orientation},
                        {then.origin.position, then.slave_orientation}, after.length_scale))
        nodes[joint.slave] = then.slave;
  }
}

void ModelCorrespondence::find_points(const Model& before, const Model& after) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i] < 0 || !after.links[i].beam) continue;
    const BeamLink &now = *after.links[i].beam, &then = *before.links[links[i]].beam;
    for_each_group(after.beams, [&](const auto& group) {
      using Group = std::decay_t<decltype(group)>;
      if (Group::kNodes != now.order + 1) return;
      const auto& elements = std::get<Group>(before.beams).elements;
      for (std::size_t k = 0; k < now.elements.size(); ++k) {
        const auto &own = group.elements[now.elements[k]], &other = elements[then.elements[k]];
        for (int p = 0; p < own.kStiffnessPoints; ++p)
          stiffness_points[own.first_stiffness_point + p] = other.first_stiffness_point + p;
        for (int p = 0; p < own.kMassPoints; ++p) mass_points[own.first_mass_point + p] = other.first_mass_point + p;
      }
    });
  }
}

std::optional<std::string> link_with_other_mesh(const Model& before, const Model& after) {
  const std::vector<int> links = same_names(before.links, after.links);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i] < 0) continue;
    const std::optional<BeamLink>&then = before.links[links[i]].beam, &now = after.links[i].beam;
    if (!then && !now) continue;
    const bool is_same =
        then && now && then->order == now->order &&
        std::equal(then->element_ends.begin(), then->element_ends.end(), now->element_ends.begin(),
                   now->element_ends.end(), [&](double a, double b) { return std::abs(a - b) <= 1e-9 * now->length; });
    if (!is_same) return after.links[i].name;
  }
  return std::nullopt;
}

}  // namespace flexarm
