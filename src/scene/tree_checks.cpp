#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "scene/scene_checks.h"
#include "scene/scene_names.h"

namespace flexarm::scene {
namespace {

/// Declares the link "world" if joints use it, nobody declares it, and no other link could be the root.
void declare_world(SceneDescription& scene, Findings& findings) {
  std::set<std::string> names, children;
  for (const LinkDescription& link : scene.links) names.insert(link.name);
  for (const JointDescription& joint : scene.joints) children.insert(joint.child);
  const auto first = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [](const JointDescription& joint) { return joint.parent == kWorld; });
  if (first == scene.joints.end() || names.count(kWorld) > 0 ||
      !std::includes(children.begin(), children.end(), names.begin(), names.end()))
    return;
  findings.warning(first->location.line, element_of("joint", first->name),
                   "its parent is no link of the scene; <link name=\"world\"/> is added, as the root", quoted(kWorld));
  LinkDescription world;
  world.name = kWorld;
  world.location = first->location;
  scene.links.push_back(world);
}

/// Records errors for joints whose parent or child is not a link of the scene.
void check_links(const SceneDescription& scene, const std::vector<JointDescription>& joints, const char* joint_tag,
                 Findings& findings) {
  const std::vector<std::string> names = link_names(scene);
  const std::set<std::string> links(names.begin(), names.end());
  for (const JointDescription& joint : joints)
    for (const auto& [tag, name] : {std::pair("parent", joint.parent), std::pair("child", joint.child)})
      if (!name.empty() && links.count(name) == 0)
        findings.error(joint.location.line, element_of(joint_tag, joint.name),
                       std::string(tag) + " must be a link of the scene" + findings.candidates(name, names),
                       quoted(name));
}

/// Returns, by the name of each link, the joint whose child it is. Records errors for links that are the child of two
/// joints.
std::map<std::string, const JointDescription*> find_parents(const SceneDescription& scene, Findings& findings) {
  std::map<std::string, const JointDescription*> parents;
  for (const JointDescription& joint : scene.joints) {
    const std::string element = element_of("joint", joint.name);
    if (!joint.parent.empty() && joint.parent == joint.child)
      findings.error(joint.location.line, element, "parent and child must be different links", quoted(joint.child));
    const auto [first, is_new] = parents.emplace(joint.child, &joint);
    if (!is_new && !joint.child.empty())
      findings.error(joint.location.line, element,
                     "a link is the child of one joint only, and this one has " + quoted(first->second->name) + " (" +
                         line_text(first->second->location) + ")",
                     quoted(joint.child));
  }
  return parents;
}

void check_rings(const SceneDescription& scene, const std::map<std::string, const JointDescription*>& parents,
                 Findings& findings) {
  const auto above = [&](const std::string& link) -> std::optional<std::string> {
    const auto joint = parents.find(link);
    // An error for a joint from a link to itself is recorded already.
    if (joint == parents.end() || joint->second->parent == link) return std::nullopt;
    return joint->second->parent;
  };
  for (const std::string& link : find_rings(scene.links, above)) {
    const JointDescription& joint = *parents.at(link);
    findings.error(joint.location.line, element_of("joint", joint.name),
                   "joints must form a tree, but their parents form a ring", quoted(link));
  }
}

}  // namespace

void check_tree(SceneDescription& scene, Findings& findings) {
  const std::size_t errors = findings.error_count();
  if (errors == 0) declare_world(scene, findings);
  check_unique(scene.links, "link", findings);
  std::vector<JointDescription> loop_joints = scene.loop_joints;
  for (const ClearanceDescription& clearance : scene.clearances)
    if (clearance.closes_loop) loop_joints.push_back(clearance.joint);
  check_unique(loop_joints, "loop_joint", findings, check_unique(scene.joints, "joint", findings));
  check_links(scene, scene.joints, "joint", findings);
  check_links(scene, loop_joints, "loop_joint", findings);
  const std::map<std::string, const JointDescription*> parents = find_parents(scene, findings);
  check_rings(scene, parents, findings);
  const bool are_joints_good = findings.error_count() == errors &&
                               std::all_of(scene.joints.begin(), scene.joints.end(), [](const JointDescription& joint) {
                                 return !joint.parent.empty() && !joint.child.empty();
                               });
  const LinkDescription* root = nullptr;
  for (const LinkDescription& link : scene.links) {
    if (link.name.empty() || parents.count(link.name) > 0) continue;
    if (!root) {
      root = &link;
    } else if (are_joints_good) {
      findings.error(link.location.line, element_of("link", link.name),
                     "must be the child of a joint: a scene has one root link, and that is " + quoted(root->name));
    }
  }
  if (root) scene.root_link = root->name;
}

}  // namespace flexarm::scene
