#include "building/passes.h"

#include <algorithm>
#include <set>

#include "building/rigid_body.h"

namespace flexarm {
namespace {

class HeldJointFinder {
 public:
  HeldJointFinder(const scene::SceneDescription& scene, const LinkNames& links, const JointTree& tree)
      : scene_(scene), links_(links), tree_(tree), touched_(scene.links.size(), false) {
    for (const scene::JointDescription& loop : scene.loop_joints) mark_loop(loop);
    for (const auto& element : scene.force_elements)
      for (const scene::LinkPoint& point : element->points()) touched_[links[point.link]] = true;
    for (const scene::ClearanceDescription& clearance : scene.clearances)
      touched_[links[clearance.joint.parent]] = touched_[links[clearance.joint.child]] = true;
    for (const scene::LinkDescription& link : scene.links)
      if (link.drag) touched_[links[link.name]] = true;
    // Forces of contacts are not known beforehand, so every link may be acted upon.
    if (!scene.contacts.empty()) touched_.assign(scene.links.size(), true);
    for (const scene::PointLoad& load : scene.loads)
      if (may_stand_in_world(links[load.link])) touched_[links[load.link]] = true;
    for (const scene::DriveDescription& drive : scene.drives)
      for (const scene::JointDescription& joint : scene.joints)
        if (drive.axis && joint.name == drive.coordinate) touched_[links[joint.parent]] = true;
    for (const scene::JointDescription& joint : scene.joints)
      if (joint.mimic && !constant_motion(joint.name)) unsuitable_.insert({joint.name, joint.mimic->joint});
    for (const scene::SpringDescription& spring : scene.springs) unsuitable_.insert(spring.coordinate);
    for (const scene::JointEffort& effort : scene.efforts) unsuitable_.insert(effort.coordinate);
  }

  std::unordered_map<std::string, double> find() {
    for (auto joint = tree_.joints.rbegin(); joint != tree_.joints.rend(); ++joint) {  // from the leaves
      const std::optional<double> position = constant_motion((*joint)->name);
      if (position && is_suitable(**joint) && !is_touched((*joint)->child)) held_[(*joint)->name] = *position;
    }
    return std::move(held_);
  }

 private:
  /// Marks the joints between the two links that a loop joint connects.
  void mark_loop(const scene::JointDescription& loop) {
    std::set<std::string> above[2];
    for (const int side : {0, 1}) {
      int link = links_[side == 0 ? loop.parent : loop.child];
      touched_[link] = true;
      for (const scene::JointDescription* joint = tree_.above[link]; joint; joint = tree_.above[links_[joint->parent]])
        above[side].insert(joint->name);
    }
    std::set_symmetric_difference(above[0].begin(), above[0].end(), above[1].begin(), above[1].end(),
                                  std::inserter(unsuitable_, unsuitable_.end()));
  }

  /// Whether a link could be a part of the world, on which no load can act.
  bool may_stand_in_world(int link) const {
    if (scene_.links[link].beam) return false;
    const scene::JointDescription* joint = tree_.above[link];
    return !joint || ((joint->kind == scene::JointKind::Fixed || constant_motion(joint->name)) &&
                      may_stand_in_world(links_[joint->parent]));
  }

  std::optional<double> constant_motion(const std::string& coordinate) const {
    const auto& motions = scene_.motions;
    const auto is_own = [&](const scene::PrescribedMotion& motion) { return motion.coordinate == coordinate; };
    const auto motion = std::find_if(motions.begin(), motions.end(), is_own);
    if (motion == motions.end() || std::count_if(motions.begin(), motions.end(), is_own) > 1) return std::nullopt;
    return motion->position.constant();
  }

  bool is_suitable(const scene::JointDescription& joint) const {
    using scene::JointKind;
    const bool is_plain =
        joint.kind == JointKind::Revolute || joint.kind == JointKind::Continuous || joint.kind == JointKind::Prismatic;
    return is_plain && joint.friction_law.law != scene::FrictionDescription::Law::Coulomb &&
           joint.friction_law.coefficient == 0 && unsuitable_.count(joint.name) == 0 &&
           !measures_reaction(scene_, joint.child);
  }

  /// Whether something acts on a link, or on a link that is one body with it.
  bool is_touched(const std::string& link) const {
    const int index = links_[link];
    if (scene_.links[index].beam) return false;
    if (touched_[index]) return true;
    return std::any_of(tree_.below[index].begin(), tree_.below[index].end(), [&](const scene::JointDescription* joint) {
      return (joint->kind == scene::JointKind::Fixed || held_.count(joint->name) > 0) && is_touched(joint->child);
    });
  }

  const scene::SceneDescription& scene_;
  const LinkNames& links_;
  const JointTree& tree_;
  std::vector<bool> touched_;         // per link: something other than joints of the tree acts on it
  std::set<std::string> unsuitable_;  // names of joints
  std::unordered_map<std::string, double> held_;
};

/// Adds a link, and those that are one body with it, to what a held joint carries.
void add_link(const ScenePlan& plan, const Mechanism& mechanism, const Model& model, int link, int node,
              RigidBody& body, HeldJoint& held) {
  const Attachment& frame = model.links[link].frame;
  if (plan.meshes[link] || frame.node != node) {  // it has a node and a joint of its own
    held.outboard.push_back(mechanism.slave_joint[frame.node]);
    return;
  }
  held.links[link] = true;
  if (const std::optional<scene::RigidInertia>& inertial = plan.scene.links[link].inertial)
    body += body_of(*inertial, frame.offset);
  for (const JointChain& chain : mechanism.tree_joints) {
    if (plan.links[chain.joint->parent] != link) continue;
    if (chain.map_count > 0)
      held.outboard.push_back(chain.first_map);
    else
      add_link(plan, mechanism, model, plan.links[chain.joint->child], node, body, held);
  }
}

}  // namespace

std::unordered_map<std::string, double> joints_to_hold(const scene::SceneDescription& scene, const LinkNames& links,
                                                       const JointTree& tree) {
  return HeldJointFinder(scene, links, tree).find();
}

void describe_held_joints(const ScenePlan& plan, const Mechanism& mechanism, Model& model) {
  for (HeldJoint& held : model.held) {
    const Coordinate& coordinate = model.coordinates[held.coordinate];
    const auto chain = std::find_if(mechanism.tree_joints.begin(), mechanism.tree_joints.end(),
                                    [&](const JointChain& each) { return each.joint->name == coordinate.name; });
    RigidBody body;
    held.links.assign(model.links.size(), false);
    add_link(plan, mechanism, model, plan.links[chain->joint->child], model.joints[coordinate.joint].master, body,
             held);
    held.mass = body.mass;
    held.centre = body.center;
    held.inertia = body.inertia;
  }
}

}  // namespace flexarm
