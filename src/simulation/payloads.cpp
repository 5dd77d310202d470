#include "flexarm/simulation/payloads.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "building/model_builder.h"
#include "model/carried_origin.h"
#include "simulation/impact.h"
#include "simulation/inside.h"
#include "simulation/observables.h"
#include "simulation/rebuilt.h"
#include "simulation/refinement.h"
#include "simulation/scene_edits.h"

namespace flexarm {
namespace {

/// Marks, as SourceLocation::file, the <no_contact> pairs that attach() adds, so that detach() can remove them.
constexpr const char* kByAttaching = "attached";

std::size_t link_index(const Simulation& simulation, const std::string& name) {
  const std::vector<std::string>& names = simulation.link_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument(fmt::format("there is no link '{}'", name));
  return static_cast<std::size_t>(found - names.begin());
}

/// The place of a fixed joint between two links.
struct JointPlace {
  Attachment parent;          ///< a node of the parent, and the joint's frame relative to this node
  Pose origin, child_origin;  ///< the joint's frame relative to each link, undeformed
};

/// Nodes at the borders between a beam's elements as the scene gives them, and at its ends.
std::vector<int> borders_of(const Model& model, const BeamLink& beam) {
  std::vector<int> borders;
  for_each_group(model.beams, [&](const auto& group) {
    if (std::decay_t<decltype(group)>::kNodes != beam.order + 1) return;
    for (std::size_t k = 0; k < beam.elements.size(); ++k) {
      const auto& nodes = group.elements[beam.elements[k]].nodes;
      if (borders.empty()) borders.push_back(nodes.front());
      if (k + 1 == beam.parts.size() || beam.parts[k + 1].element != beam.parts[k].element)
        borders.push_back(nodes.back());
    }
  });
  return borders;
}

/// The joint is at the child's frame. On a flexible parent it is at the border between elements that is nearest to that
/// frame.
JointPlace place_on(const Simulation& simulation, std::size_t parent, std::size_t child) {
  const Model& model = model_of(simulation);
  const State& state = state_of(simulation);
  const LinkFrame& on = model.links[parent];
  const Pose frame = simulation.link_pose(child);
  if (!on.beam) return {on.frame, simulation.link_pose(parent).inverse() * frame, Pose()};
  const Vector3 own = attached_pose(state, model.links[child].frame).position;
  const auto distance = [&](int node) { return (state.nodes[node].position - own).norm(); };
  const std::vector<int> borders = borders_of(model, *on.beam);
  const int node =
      *std::min_element(borders.begin(), borders.end(), [&](int a, int b) { return distance(a) < distance(b); });
  // The section's frame is on the reference line, whereas nodes are at the mass centroid.
  const Pose section{-on.beam->centroid, Quaternion::Identity()};
  const State undeformed = initial_state(model);
  const Pose origin = attached_pose(undeformed, on.frame).inverse() * attached_pose(undeformed, {node, section});
  const Pose now = attached_pose(state, {node, section});
  return {{node, section}, origin, attached_pose(state, model.links[child].frame).inverse() * now};
}

/// The model of the simulation's initial state, in which other elements may be halved than now.
Model initial_model_of(const Simulation& simulation) {
  const std::vector<HalvedElement>& halved = initial_state_of(simulation).halved;
  if (model_of(simulation).halved == halved) return model_of(simulation);
  scene::SceneDescription scene = simulation.scene();
  set_halved(halved, scene);
  return build_model(scene);
}

/// Pose and velocity of a link at the start.
scene::LinkStart start_of(const Simulation& simulation, std::size_t index) {
  const Model model = initial_model_of(simulation);
  const State& state = initial_state_of(simulation);
  const Attachment& frame = model.links[index].frame;
  scene::LinkStart start{attached_pose(state, frame)};
  if (frame.node < 0) {
    start.pose.position += model.origin;
    return start;
  }
  const Vector6 velocity = spatial_velocity(state.nodes[frame.node]);
  start.angular = velocity.tail<3>();
  start.linear = velocity.head<3>() + start.angular.cross(start.pose.position - state.nodes[frame.node].position);
  start.pose.position += world_origin(model, state);
  return start;
}

void require_free(const scene::SceneDescription& scene, const std::string& link, const std::string& to) {
  const scene::JointDescription* joint = scene::joint_above(scene, link);
  if (!joint) throw std::invalid_argument(fmt::format("link '{}' is the world: it cannot be attached", link));
  if (joint->kind == scene::JointKind::Fixed)
    throw std::invalid_argument(
        fmt::format("link '{}' is attached already: joint '{}' fixes it to '{}'; detach it first", link, joint->name,
                    joint->parent));
  if (joint->kind != scene::JointKind::Floating || joint->parent != scene.root_link)
    throw std::invalid_argument(
        fmt::format("link '{}' does not float: joint '{}' carries it on '{}'", link, joint->name, joint->parent));
  const std::set<std::string> branch = scene::branch_of(scene, link);
  if (branch.count(to) > 0)
    throw std::invalid_argument(fmt::format("a loop would arise: link '{}' hangs on '{}'", to, link));
  for (const scene::JointDescription& loop : scene.loop_joints)
    if (branch.count(loop.parent) != branch.count(loop.child))
      throw std::invalid_argument(
          fmt::format("a loop would arise: loop joint '{}' ties '{}' to '{}'", loop.name, loop.parent, loop.child));
  for (const scene::ClearanceDescription& clearance : scene.clearances)
    if (branch.count(clearance.joint.parent) != branch.count(clearance.joint.child))
      throw std::invalid_argument(
          fmt::format("link '{}' does not float: joint '{}', which has play, holds it", link, clearance.joint.name));
  if (const auto what = scene::what_drives(scene, *joint))
    throw std::invalid_argument(
        fmt::format("link '{}' does not float freely: a <{}> acts upon its joint '{}'", link, *what, joint->name));
}

/// Links that form one body with this link, by fixed joints.
std::set<std::string> body_of(const scene::SceneDescription& scene, const std::string& link) {
  std::set<std::string> body{link};
  for (bool grows = true; grows;) {
    grows = false;
    for (const scene::JointDescription& joint : scene.joints)
      if (joint.kind == scene::JointKind::Fixed && body.count(joint.parent) != body.count(joint.child)) {
        body.insert(joint.parent);
        body.insert(joint.child);
        grows = true;
      }
  }
  return body;
}

}  // namespace

void attach(Simulation& simulation, const std::string& link, const std::string& to) {
  const std::size_t child = link_index(simulation, link), parent = link_index(simulation, to);
  scene::SceneDescription scene = simulation.scene();
  require_free(scene, link, to);
  const JointPlace place = place_on(simulation, parent, child);
  const Model& model = model_of(simulation);
  const State after =
      after_impact(model, scheme_of(simulation), state_of(simulation), place.parent, model.links[child].frame);

  for (const std::string& one : body_of(scene, to))
    for (const std::string& other : body_of(scene, link)) {
      scene::ContactPair& pair = scene.no_contacts.emplace_back();
      pair.first = one;
      pair.second = other;
      pair.location.file = kByAttaching;
    }
  scene::JointDescription& joint = *scene::joint_above(scene, link);
  scene::forget_start(scene, joint);
  joint.kind = scene::JointKind::Fixed;
  joint.parent = to;
  joint.origin = place.origin;
  joint.child_origin = place.child_origin;
  go_on_with(simulation, after, scene, {link, to}, EnergyChange::Dissipated);
}

void detach(Simulation& simulation, const std::string& link) {
  const std::size_t index = link_index(simulation, link);
  scene::SceneDescription scene = simulation.scene();
  scene::JointDescription* joint = scene::joint_above(scene, link);
  if (!joint) throw std::invalid_argument(fmt::format("link '{}' is the world: it hangs on nothing", link));
  if (joint->kind == scene::JointKind::Floating)
    throw std::invalid_argument(fmt::format("link '{}' floats: it is attached to nothing", link));
  if (joint->kind != scene::JointKind::Fixed)
    throw std::invalid_argument(
        fmt::format("link '{}' hangs on joint '{}', which is not of type 'fixed'", link, joint->name));
  const std::set<std::string> branch = scene::branch_of(scene, link);
  auto& pairs = scene.no_contacts;
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const scene::ContactPair& pair) {
                               return pair.location.file == kByAttaching &&
                                      branch.count(pair.first) != branch.count(pair.second);
                             }),
              pairs.end());
  const std::string parent = joint->parent;
  scene::keep_border(scene, parent, joint->origin.position);
  scene::let_float(scene, *joint, start_of(simulation, index));
  go_on_with(simulation, state_of(simulation), scene, {link, parent}, EnergyChange::Dissipated);
}

}  // namespace flexarm
