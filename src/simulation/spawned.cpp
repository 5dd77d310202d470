#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "flexarm/simulation/payloads.h"
#include "simulation/inside.h"
#include "simulation/rebuilt.h"
#include "simulation/scene_edits.h"

namespace flexarm {
namespace {

constexpr const char* kWorldLink = "world";

/// Removes the floating root that a reader has added, which is the world and one joint. Then the model's own root link
/// is the root again.
void take_floating_root(scene::SceneDescription& model) {
  scene::JointDescription* only = nullptr;
  for (scene::JointDescription& joint : model.joints)
    if (joint.parent == model.root_link) {
      if (only) return;
      only = &joint;
    }
  if (!only || only->kind != scene::JointKind::Floating || scene::what_drives(model, *only)) return;
  const std::string world = model.root_link, root = only->child;
  for (const scene::InitialJoint& initial : model.initial_joints)
    if (initial.coordinate.compare(0, only->name.size() + 1, only->name + "/") == 0)
      return;  // the model gives its own
               // initial pose
  forget_start(model, *only);
  model.joints.erase(model.joints.begin() + (only - model.joints.data()));
  for (std::size_t i = 0; i < model.links.size(); ++i)
    if (model.links[i].name == world) {
      model.links.erase(model.links.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  model.root_link = root;
}

/// Moves the joints on the world, and the points of force elements and cylinders there, by the pose at which the model
/// is placed.
void place_on_world(scene::SceneDescription& model, const Spawn& where) {
  if (!where.linear.isZero(0) || !where.angular.isZero(0))
    throw std::invalid_argument(
        "a velocity is for a model whose root link floats: the root link of this one is the world");
  for (scene::JointDescription& joint : model.joints)
    if (joint.parent == model.root_link) joint.origin = where.pose * joint.origin;
  for (scene::JointDescription& loop : model.loop_joints) {
    if (loop.parent == model.root_link) loop.origin = where.pose * loop.origin;
    if (loop.child == model.root_link) loop.child_origin = where.pose * loop.child_origin;
  }
  for (auto& element : model.force_elements)
    element = element->with_links([&](const std::string& link) {
      return scene::LinkChange{link, link == model.root_link ? where.pose : Pose()};
    });
  for (scene::CylinderDescription& cylinder : model.cylinders) {
    if (cylinder.from == model.root_link) cylinder.from_at = where.pose * cylinder.from_at;
    if (cylinder.to == model.root_link) cylinder.to_at = where.pose * cylinder.to_at;
  }
}

/// Calls `visit(name)` for each link's name in the model's joints, force elements and cylinders.
template <class Visit>
void for_each_end(scene::SceneDescription& model, const Visit& visit) {
  for (auto* joints : {&model.joints, &model.loop_joints})
    for (scene::JointDescription& joint : *joints) visit(joint.parent), visit(joint.child);
  for (scene::CylinderDescription& cylinder : model.cylinders) visit(cylinder.from), visit(cylinder.to);
  for (auto& element : model.force_elements) element = scene::with_link_names(*element, visit);
}

/// Lets the reels of winches travel along the world's x axis, wherever the model is.
void put_reels_on_world(scene::SceneDescription& model, const std::string& world) {
  for (const auto& element : model.force_elements)
    for (const scene::LinkPoint& point : element->points())
      if (point.attribute == scene::kReel) {
        scene::JointDescription& travel = *joint_above(model, point.link);
        travel.parent = world;
        travel.origin = Pose();
      }
}

void add_floating_joint(scene::SceneDescription& model, const std::string& world, const Spawn& where) {
  const std::string root = model.root_link;
  scene::JointDescription joint;
  joint.name = root;
  joint.child = root;
  model.root_link = world;
  model.joints.insert(model.joints.begin(), joint);
  scene::JointDescription& added = model.joints.front();
  for (scene::LinkDescription& link : model.links)
    if (link.name == root) added.location = link.location;
  let_float(model, added, {where.pose, where.linear, where.angular});
}

}  // namespace

void spawn(Simulation& simulation, const scene::SceneDescription& model, const Spawn& where) {
  if (!where.pose.position.allFinite() || !where.pose.orientation.coeffs().allFinite() || !where.linear.allFinite() ||
      !where.angular.allFinite())
    throw std::invalid_argument("the pose and the velocity of a model must be finite");
  if (where.pose.orientation.norm() < 1e-6)
    throw std::invalid_argument("the orientation of a model must be a unit quaternion");
  Spawn placed = where;
  placed.pose.orientation.normalize();
  scene::SceneDescription scene = simulation.scene(), added = model;
  if (added.root_link == kWorldLink || added.root_link == scene.root_link) take_floating_root(added);
  if (added.root_link == kWorldLink || added.root_link == scene.root_link) {
    rename(added, where.prefix);
    place_on_world(added, placed);
    for_each_end(added, [&](std::string& link) {
      if (link == added.root_link) link = scene.root_link;
    });
    for (scene::LinkDescription& link : added.links)
      if (link.name == added.root_link) link.name = scene.root_link;
  } else {
    const std::string own = std::exchange(added.root_link, "");  // so that the root link gets a prefix, too
    rename(added, where.prefix);
    added.root_link = where.prefix + own;
    add_floating_joint(added, scene.root_link, placed);
  }
  put_reels_on_world(added, scene.root_link);
  merge(scene, added);
  go_on_with(simulation, state_of(simulation), scene, {}, EnergyChange::Work);
}

void remove(Simulation& simulation, const std::string& link) {
  scene::SceneDescription scene = simulation.scene();
  const auto is_meant = [&](const scene::LinkDescription& each) { return each.name == link; };
  if (std::none_of(scene.links.begin(), scene.links.end(), is_meant))
    throw std::invalid_argument(fmt::format("there is no link '{}'", link));
  if (link == scene.root_link) throw std::invalid_argument(fmt::format("link '{}' is the world: it stays", link));
  const std::string parent = scene::joint_above(scene, link)->parent;
  take_away(scene, link);
  go_on_with(simulation, state_of(simulation), scene, {parent}, EnergyChange::Work);
}

}  // namespace flexarm
