#include "scene/scene_checks.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "flexarm/scene/sensor_topic.h"
#include "scene/flexible_link.h"
#include "scene/scene_names.h"

namespace flexarm::scene {
namespace {

class ReferenceCheck {
 public:
  ReferenceCheck(const SceneDescription& scene, const std::set<std::string>& unreadable, Findings& findings)
      : scene_(scene),
        unreadable_(unreadable),
        findings_(findings),
        link_names_(link_names(scene)),
        touching_names_(link_names_) {
    for (const GroundDescription& ground : scene.grounds) touching_names_.push_back(ground.name);
    for (const LinkDescription& link : scene.links) links_.emplace(link.name, &link);
    for (const JointDescription& joint : scene.joints) add_joint(joint);
    for (const JointDescription& joint : scene.loop_joints) {
      add_joint(joint);
      loops_.insert(joint.name);
    }
    for (const auto& [name, joint] : coordinates_)
      if (!joint->mimic && !joint->name.empty()) coordinate_names_.push_back(name);
  }

  void check_mimics() const {
    for (const JointDescription& joint : scene_.joints)
      if (joint.mimic) check_mimic(joint);
    const auto mimicked = [&](const std::string& name) -> std::optional<std::string> {
      const auto joint = joints_.find(name);
      return joint != joints_.end() && joint->second->mimic ? std::optional(joint->second->mimic->joint) : std::nullopt;
    };
    for (const std::string& name : find_rings(scene_.joints, mimicked)) {
      const JointDescription& joint = *joints_.at(name);
      findings_.error(joint.location.line, element_of("joint", name),
                      "a joint must not mimic itself, directly or through others", quoted(joint.mimic->joint));
    }
  }

  void check_simulation() const {
    check_coordinates_of_simulation();
    std::set<std::string> moving;
    for (const InitialLink& initial : scene_.initial_links) {
      const char* element = "<initial> of simulation";
      check_link(initial.link, initial.location, element);
      if (initial.link == scene_.root_link && !scene_.root_link.empty())
        findings_.error(initial.location.line, element,
                        "the root link is clamped and cannot move, unless <root type=\"floating\"/> lets it float",
                        quoted(initial.link));
      if (!moving.insert(initial.link).second)
        findings_.error(initial.location.line, element, "the link has an initial velocity already",
                        quoted(initial.link));
    }
    for (const PointLoad& load : scene_.loads) check_link(load.link, load.location, "<load> of simulation");
    for (const DistributedLoad& load : scene_.distributed_loads) {
      const char* element = "<distributed_load> of simulation";
      check_link(load.link, load.location, element);
      const auto link = links_.find(load.link);
      // If the link's <beam> has an error, that is recorded already. Here only a link without <beam> is an error.
      if (link != links_.end() && !link->second->beam && unreadable_.count(load.link) == 0)
        findings_.error(load.location.line, element, "link must have a <beam>", quoted(load.link));
    }
    for (const Probe& probe : scene_.probes) check_link(probe.link, probe.location, "<probe> of simulation");
    check_unique(scene_.probes, "probe", findings_);
  }

  void check_force_elements() const {
    NamesTaken taken;
    for (const auto& element : scene_.force_elements) {
      for (const auto& [attribute, link, at] : element->points())
        if (!link.empty() && links_.count(link) == 0)
          findings_.error(element->location.line, fmt::format("<{}> of robot {}", element->kind(), quoted(scene_.name)),
                          attribute + " must be a link of the scene" + findings_.candidates(link, link_names_),
                          quoted(link));
      if (!element->name.empty()) check_name(*element, element->kind(), findings_, taken);
    }
  }

  void check_sensors() const {
    check_unique(scene_.sensors, "sensor", findings_);
    for (const Sensor& sensor : scene_.sensors) check_sensor(sensor);
    check_topics();
  }

 private:
  /// Warns about sensors with different names that publish on the same topic.
  void check_topics() const {
    std::map<std::string, const Sensor*> topics;
    for (const Sensor& sensor : scene_.sensors) {
      const auto [first, is_new] = topics.emplace(sensor_topic(sensor.name), &sensor);
      const Sensor& other = *first->second;
      if (!is_new && other.name != sensor.name)
        findings_.warning(sensor.location.line, element_of("sensor", sensor.name),
                          "shares the topic '" + first->first + "' with sensor " + quoted(other.name) + " (" +
                              line_text(other.location) +
                              "): in topics and bags, characters other than letters, digits and _ become _");
    }
  }

  void check_sensor(const Sensor& sensor) const {
    const std::string element = element_of("sensor", sensor.name);
    check_link(sensor.link, sensor.location, element.c_str());
    const auto link = links_.find(sensor.link);
    if (link == links_.end() || unreadable_.count(sensor.link) > 0) return;
    const SensedPlace place = traits_of(sensor.kind).place;
    const bool needs_beam = place == SensedPlace::Section, needs_joint = place == SensedPlace::Joint;
    if (needs_beam && !is_flexible(*link->second))
      findings_.error(sensor.location.line, element, "link must be flexible, that is have a <beam> with elements",
                      quoted(sensor.link));
    if (!sensor.joint.empty() && !(needs_joint && closes_loop_at(sensor.joint, sensor.link)))
      findings_.error(sensor.location.line, element,
                      "joint is for wrenches and reactions: a loop joint that has the link as its parent or child",
                      quoted(sensor.joint));
    else if (needs_joint && sensor.joint.empty() && sensor.link == scene_.root_link)
      findings_.error(sensor.location.line, element, "no joint carries the root link", quoted(sensor.link));
    else if (needs_joint && sensor.joint.empty() && has_play_above(sensor.link))
      findings_.error(sensor.location.line, element,
                      "the joint that carries the link has a <clearance>, and transmits forces by contact only",
                      quoted(sensor.link));
    check_group(sensor, element);
  }

  bool has_play_above(const std::string& link) const {
    return std::any_of(scene_.clearances.begin(), scene_.clearances.end(),
                       [&](const ClearanceDescription& each) { return !each.closes_loop && each.joint.child == link; });
  }

  void check_group(const Sensor& sensor, const std::string& element) const {
    if (!sensor.group.empty() && traits_of(sensor.kind).place != SensedPlace::Touch)
      findings_.error(sensor.location.line, element, "group is for sensors of kind contact");
    const auto is_ground = [&](const std::string& name) {
      return std::any_of(scene_.grounds.begin(), scene_.grounds.end(),
                         [&](const GroundDescription& ground) { return ground.name == name; });
    };
    for (const std::string& name : sensor.group)
      if (links_.count(name) == 0 && !is_ground(name))
        findings_.error(sensor.location.line, element,
                        "group must be links and grounds of the scene" + findings_.candidates(name, touching_names_) +
                            ", separated by spaces",
                        quoted(name));
  }

  bool closes_loop_at(const std::string& name, const std::string& link) const {
    return std::any_of(scene_.loop_joints.begin(), scene_.loop_joints.end(), [&](const JointDescription& joint) {
      return joint.name == name && (joint.parent == link || joint.child == link);
    });
  }

  void add_joint(const JointDescription& joint) {
    if (joint.is_hidden) return;
    joints_.emplace(joint.name, &joint);
    for (const std::string& suffix : coordinate_suffixes(joint)) add_coordinate(joint, joint.name + suffix);
  }

  void add_coordinate(const JointDescription& joint, const std::string& name) {
    const auto [first, is_new] = coordinates_.emplace(name, &joint);
    if (!is_new && first->second->name != joint.name)
      findings_.error(
          joint.location.line, element_of("joint", joint.name),
          "a coordinate's name must be unique, but joint " + quoted(first->second->name) + " has one of this name",
          quoted(name));
  }

  void check_mimic(const JointDescription& joint) const {
    const std::string element = element_of("joint", joint.name);
    const std::string& target = joint.mimic->joint;
    const auto found = joints_.find(target);
    if (target.empty()) return;  // recorded already
    if (found == joints_.end()) {
      findings_.error(joint.location.line, element,
                      "mimic joint must be a joint of the scene" + findings_.candidates(target, names_of_others(joint)),
                      quoted(target));
      return;
    }
    if (loops_.count(target) > 0) {
      findings_.error(joint.location.line, element, "a <loop_joint> cannot be mimicked", quoted(target));
      return;
    }
    if (unreadable_.count(target) > 0 || unreadable_.count(joint.name) > 0) return;
    if (coordinate_suffixes(joint).size() != 1)
      findings_.error(joint.location.line, element, "only a joint with one coordinate can mimic");
    if (found->second->kind != JointKind::Fixed && coordinate_suffixes(*found->second).size() != 1)
      findings_.error(joint.location.line, element, "only a joint with one coordinate can be mimicked", quoted(target));
  }

  void check_coordinates_of_simulation() const {
    std::set<std::string> moved, placed;
    for (const PrescribedMotion& motion : scene_.motions)
      check_coordinate(motion.coordinate, motion.location, "<motion> of simulation", moved);
    for (const InitialJoint& initial : scene_.initial_joints) {
      const char* element = "<initial> of simulation";
      check_coordinate(initial.coordinate, initial.location, element, placed);
      check_not_prescribed(initial.coordinate, initial.location, element, moved);
      if (initial.position != 0) check_no_loop(initial.coordinate, initial.location, element);
    }
    for (const PrescribedMotion& motion : scene_.motions)
      if (motion.position(0.0) != 0) check_no_loop(motion.coordinate, motion.location, "<motion> of simulation");
    check_free_coordinates(scene_.servos, "<servo> of robot", moved);
    check_free_coordinates(scene_.drives, "<drive> of robot", moved);
    check_free_coordinates(scene_.efforts, "<effort> of simulation", moved);
    check_free_coordinates(scene_.springs, "<spring> of robot", {});
  }

  /// Checks entries of one kind. Each must name a coordinate that is not in `moved`, the prescribed ones.
  template <class Entries>
  void check_free_coordinates(const Entries& entries, const char* element, const std::set<std::string>& moved) const {
    std::set<std::string> used;
    for (const auto& entry : entries) {
      check_coordinate(entry.coordinate, entry.location, element, used);
      check_not_prescribed(entry.coordinate, entry.location, element, moved);
    }
  }

  /// Checks that the coordinate exists, does not mimic another one, and is not yet in `used`. Adds it to `used`.
  void check_coordinate(const std::string& name, const SourceLocation& location, const char* element,
                        std::set<std::string>& used) const {
    if (name.empty() || unreadable_.count(name.substr(0, name.rfind('/'))) > 0 || unreadable_.count(name) > 0) return;
    const auto found = coordinates_.find(name);
    if (found == coordinates_.end()) {
      findings_.error(location.line, element, "joint must be " + known_coordinates(name), quoted(name));
      return;
    }
    if (found->second->mimic)
      findings_.error(
          location.line, element,
          "a joint that mimics another one, " + quoted(found->second->mimic->joint) + ", has no coordinate of its own",
          quoted(name));
    if (!used.insert(name).second)
      findings_.error(location.line, element, "the coordinate has an entry of this kind already", quoted(name));
  }

  void check_not_prescribed(const std::string& name, const SourceLocation& location, const char* element,
                            const std::set<std::string>& moved) const {
    if (moved.count(name) > 0)
      findings_.error(location.line, element, "the coordinate's <motion> prescribes it already", quoted(name));
  }

  void check_no_loop(const std::string& coordinate, const SourceLocation& location, const char* element) const {
    const auto found = coordinates_.find(coordinate);
    if (found != coordinates_.end() && loops_.count(found->second->name) > 0)
      findings_.error(location.line, element,
                      "a <loop_joint> starts at 0, which is where the tree of joints places its links",
                      quoted(coordinate));
  }

  /// Names of the joints of the tree, but for one.
  std::vector<std::string> names_of_others(const JointDescription& one) const {
    std::vector<std::string> names;
    for (const auto& [name, joint] : joints_)
      if (name != one.name && !name.empty() && loops_.count(name) == 0) names.push_back(name);
    return names;
  }

  std::string known_coordinates(const std::string& name) const {
    const auto joint = joints_.find(name);
    if (joint == joints_.end())
      return "the name of a joint's coordinate" + findings_.candidates(name, coordinate_names_);
    std::string known;
    for (const std::string& suffix : coordinate_suffixes(*joint->second))
      known += (known.empty() ? "one of " : ", ") + quoted(name + suffix);
    return known.empty() ? "movable" : known;
  }

  void check_link(const std::string& name, const SourceLocation& location, const char* element) const {
    if (!name.empty() && links_.count(name) == 0)
      findings_.error(location.line, element,
                      "link must be a link of the scene" + findings_.candidates(name, link_names_), quoted(name));
  }

  const SceneDescription& scene_;
  const std::set<std::string>& unreadable_;
  Findings& findings_;
  std::map<std::string, const LinkDescription*> links_;
  std::map<std::string, const JointDescription*> joints_, coordinates_;
  /// Candidates for unknown names: links, links with grounds, and coordinates that are no followers.
  std::vector<std::string> link_names_, touching_names_, coordinate_names_;
  std::set<std::string> loops_;  // names of joints that close loops
};

}  // namespace

std::string sensor_topic(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return "sensors/" + name;
}

void check_references(const SceneDescription& scene, const std::set<std::string>& unreadable, Findings& findings) {
  const ReferenceCheck check(scene, unreadable, findings);
  check.check_mimics();
  check.check_simulation();
  check.check_force_elements();
  check.check_sensors();
  if (findings.error_count() == 0) check_followers(scene, findings);
}

}  // namespace flexarm::scene
