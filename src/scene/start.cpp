#include "scene/start.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "scene/scene_names.h"

namespace flexarm::scene {
namespace {

constexpr const char* kRootJoint = "root";

template <class Named>
const Named* find(const std::vector<Named>& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(), [&](const Named& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

/// Whether a name that the floating root needs is free; if not, records an error.
template <class Named>
bool is_free(const std::vector<Named>& things, const char* tag, const char* name, int line, Findings& findings) {
  const Named* taken = find(things, name);
  if (taken)
    findings.error(line, "<root> of simulation",
                   fmt::format("a floating root link needs the name {} for a {}, which is already used in line {}",
                               quoted(name), tag, taken->location.line));
  return !taken;
}

void let_root_float(SceneDescription& scene, const SourceLocation& location, Findings& findings) {
  const bool is_link_free = is_free(scene.links, "link", kWorld, location.line, findings);
  const bool is_joint_free = is_free(scene.joints, "joint", kRootJoint, location.line, findings) &&
                             is_free(scene.loop_joints, "joint", kRootJoint, location.line, findings);
  if (!is_link_free || !is_joint_free) return;
  JointDescription joint;
  joint.name = kRootJoint;
  joint.kind = JointKind::Floating;
  joint.parent = kWorld;
  joint.child = scene.root_link;
  joint.location = location;
  scene.joints.push_back(joint);
  LinkDescription world;
  world.name = scene.root_link = kWorld;
  world.location = location;
  scene.links.push_back(world);
}

/// Mass of the root link and of links that are rigidly fixed to it [kg]. Links behind a beam do not count, since they
/// move.
double clamped_mass(const SceneDescription& scene) {
  std::map<std::string, std::vector<std::string>> fixed;  // by parent: the links fixed to it
  for (const JointDescription& joint : scene.joints)
    if (joint.kind == JointKind::Fixed) fixed[joint.parent].push_back(joint.child);
  std::map<std::string, const LinkDescription*> links;
  for (const LinkDescription& link : scene.links) links.emplace(link.name, &link);
  double mass = 0;
  std::vector<std::string> stack = {scene.root_link};
  while (!stack.empty()) {
    const auto link = links.find(stack.back());
    stack.pop_back();
    if (link == links.end() || link->second->beam) continue;
    if (link->second->inertial) mass += link->second->inertial->mass;
    const std::vector<std::string>& further = fixed[link->first];
    stack.insert(stack.end(), further.begin(), further.end());
    links.erase(link);  // so that each link counts once, even in a faulty tree
  }
  return mass;
}

/// Records an error if a coordinate is to start at its nearest limit, and its joint has no limits.
void check_limited(const SceneDescription& scene, const std::string& coordinate, int line, Findings& findings) {
  const JointDescription* joint = find(scene.joints, coordinate);
  if (!joint) joint = find(scene.joints, coordinate.substr(0, coordinate.rfind('/')));  // of a joint with several
  if (joint && !joint->mimic && !joint->limits)
    findings.error(line, "<initial> of simulation",
                   "position may be 'clamp' only for a joint with lower and upper limits", quoted(coordinate));
}

/// Whether a joint has stops that act: it has valid limits, mimics no joint, and its motion is not prescribed.
bool has_stops(const JointDescription& joint, const std::set<std::string>& moved) {
  return joint.limits && joint.limits->lower <= joint.limits->upper && !joint.mimic && moved.count(joint.name) == 0;
}

/// Warns if a joint starts outside its limits. `advice`: end of the message, on how to start inside them.
void check_start(const JointDescription& joint, double position, const SourceLocation& location,
                 const std::string& advice, Findings& findings) {
  if (position >= joint.limits->lower && position <= joint.limits->upper) return;
  findings.warning(location.line, element_of("joint", joint.name),
                   fmt::format("starts outside its limits, {} to {}, and its stop will push it back{}",
                               joint.limits->lower, joint.limits->upper, advice),
                   fmt::format("'{}'", position));
}

/// If <initial> gives a slider's velocity but not its position, the slider starts at the position that its <slide>
/// gives.
void start_sliders(const SceneDescription& scene, const std::set<std::string>& placed,
                   const std::map<std::string, InitialJoint*>& initials) {
  for (const JointDescription& joint : scene.joints) {
    if (!joint.slide) continue;
    const std::string travel = joint.name + coordinate_suffixes(joint).front();
    const auto initial = initials.find(travel);
    if (initial != initials.end() && placed.count(travel) == 0) initial->second->position = joint.slide->start;
  }
}

}  // namespace

void settle_root(SceneDescription& scene, const StartRequest& request, Findings& findings) {
  if (scene.root_link.empty()) return;
  if (request.root) {
    if (request.root->floats) let_root_float(scene, request.root->location, findings);
    return;
  }
  if (request.is_spawned || scene.root_link == kWorld) return;  // the name says that it is clamped
  const LinkDescription* root = find(scene.links, scene.root_link);
  if (const double mass = clamped_mass(scene); root && mass > 0)
    findings.warning(
        root->location.line, element_of("link", root->name),
        "the root link is clamped, though it and what is fixed to it have a mass; <root "
        "type=\"floating\"/> in <simulation> lets it float, <root type=\"clamped\"/> confirms that it is clamped",
        fmt::format("'{}' kg", mass));
}

void settle_positions(SceneDescription& scene, const StartRequest& request, const std::set<std::string>& unreadable,
                      Findings& findings) {
  std::set<std::string> moved;
  for (const PrescribedMotion& motion : scene.motions) moved.insert(motion.coordinate);
  std::map<std::string, InitialJoint*> initials;
  for (InitialJoint& initial : scene.initial_joints) initials.emplace(initial.coordinate, &initial);
  for (const std::string& coordinate : request.clamped)
    if (unreadable.count(coordinate) == 0)
      check_limited(scene, coordinate, initials.at(coordinate)->location.line, findings);

  std::map<std::string, const char*> cylinders;  // and their pumps; these get their positions when a Simulation is made
  for (const CylinderDescription& cylinder : scene.cylinders) {
    cylinders.emplace(cylinder.name, "cylinder");
    if (!cylinder.pump.empty()) cylinders.emplace(cylinder.pump, "pump");
  }
  for (const auto* given : {&request.clamped, &request.placed})
    for (const std::string& coordinate : *given)
      if (const auto found = cylinders.find(coordinate); found != cylinders.end())
        findings.error(initials.at(coordinate)->location.line, "<initial> of simulation",
                       fmt::format("a <{}> has no initial position: it starts with the length that the positions of "
                                   "the other joints give it",
                                   found->second),
                       quoted(coordinate));
  start_sliders(scene, request.placed, initials);
  std::vector<InitialJoint> added;
  for (const JointDescription& joint : scene.joints) {
    if (!has_stops(joint, moved) || cylinders.count(joint.name) > 0) continue;
    const auto found = initials.find(joint.name);
    InitialJoint* initial = found == initials.end() ? nullptr : found->second;
    double position = initial ? initial->position : 0;
    const bool is_clamped =
        request.clamped.count(joint.name) > 0 || (request.clamps_all && request.placed.count(joint.name) == 0);
    const double nearest = std::clamp(position, joint.limits->lower, joint.limits->upper);
    if (is_clamped && nearest != position) {
      if (!initial) initial = &added.emplace_back(InitialJoint{joint.name, 0, 0, joint.location});
      initial->position = position = nearest;
    }
    check_start(joint, position, initial ? initial->location : joint.location,
                fmt::format("; <initial joint=\"{}\" position=\"clamp\"/>, or start=\"clamp\" of <simulation> "
                            "(--start clamp) for all joints, begins at the nearest limit",
                            joint.name),
                findings);
  }
  scene.initial_joints.insert(scene.initial_joints.end(), added.begin(), added.end());
  for (const JointDescription& joint : scene.loop_joints)
    if (has_stops(joint, moved)) check_start(joint, 0, joint.location, "", findings);
}

}  // namespace flexarm::scene
