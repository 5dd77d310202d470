#include "scene/strangers.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "math/number_text.h"
#include "scene/limits.h"
#include "scene/readers.h"

namespace flexarm::scene {
namespace {

/// Children of <robot> that are read, here or as URDF has them: what a misspelt name may mean.
constexpr std::string_view kOwn[] = {"link",      "joint",  "material",     "loop_joint", "spring",
                                     "drive",     "servo",  "transmission", "simulation", "sensor",
                                     "parameter", "gazebo", "ground",       "no_contact"};
/// Of other programs.
constexpr std::string_view kOfOthers[] = {"ros2_control",
                                          "mujoco",
                                          "frame",
                                          "collision_filter_group",
                                          "actuator",
                                          "force_element",
                                          "cable",  // Drake
                                          "deformable",
                                          "reduced_deformable",
                                          "bullet",  // Bullet
                                          "group",
                                          "group_state",
                                          "end_effector",
                                          "virtual_joint",
                                          "passive_joint",
                                          "chain",
                                          "disable_collisions",  // SRDF
                                          "disable_default_collisions",
                                          "enable_collisions",
                                          "link_sphere_approximation",
                                          "joint_property",
                                          "rotor",
                                          "imuSensor",
                                          "copSensor",
                                          "plugin",
                                          "isaac_sim",
                                          "simmechanics",
                                          "tendon",
                                          "muscle",
                                          "version"};
/// Ours, whose place elsewhere is an error (see urdf_reader.cpp).
constexpr std::string_view kPlaced[] = {"beam",         "release",  "axis2", "slide", "couple",
                                        "child_origin", "friction", "root",  "hub",   "clearance"};
/// Names that belong into another element.
struct Home {
  std::string_view tag, parent;
};
constexpr Home kHomes[] = {{"inertial", "link"},
                           {"visual", "link"},
                           {"collision", "link"},
                           {"contact", "link"},  // Bullet's
                           {"origin", "joint"},
                           {"parent", "joint"},
                           {"child", "joint"},
                           {"axis", "joint"},
                           {"limit", "joint"},
                           {"dynamics", "joint"},
                           {"mimic", "joint"},
                           {"safety_controller", "joint"},
                           {"gravity", "simulation"},
                           {"integrator", "simulation"},
                           {"initial", "simulation"},
                           {"load", "simulation"},
                           {"distributed_load", "simulation"},
                           {"motion", "simulation"},
                           {"effort", "simulation"},
                           {"probe", "simulation"}};

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

/// Number of characters to insert, leave out or replace, whatever their case.
std::size_t edits(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < to.size(); ++j) {
      const bool is_same = std::tolower(static_cast<unsigned char>(from[i])) == static_cast<unsigned char>(to[j]);
      const std::size_t replaced = diagonal + (is_same ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// What a name probably means: differs in a third of its characters at most; empty if nothing does.
std::string_view nearest(std::string_view tag, const std::vector<std::string_view>& own) {
  std::string_view best;
  std::size_t least = tag.size() / 3 + 1;
  if (tag.size() > 2 * kLongestParameterName) return best;  // a costly comparison with nothing to find
  for (const std::string_view name : own) {
    const std::size_t count = edits(tag, name);
    if (count >= least) continue;
    least = count;
    best = name;
  }
  return best;
}

/// Empty: it is known.
std::string advice_for(std::string_view tag, const std::vector<std::string_view>& own) {
  if (tag.find(':') != std::string_view::npos || contains(own, tag) || contains(kPlaced, tag) ||
      contains(kOfOthers, tag))
    return {};
  const auto home = std::find_if(std::begin(kHomes), std::end(kHomes), [&](const Home& it) { return it.tag == tag; });
  if (home != std::end(kHomes)) return "has no effect here: it belongs into <" + std::string(home->parent) + ">";
  const std::string_view meant = nearest(tag, own);
  return "has no effect: no program is known that uses it here" +
         (meant.empty() ? std::string() : "; is <" + std::string(meant) + "> meant?");
}

/// The name of a link as Gazebo gives it in the text of a child, without the model's name before it.
std::string link_in(const XmlElement& joint, const char* tag) {
  const tinyxml2::XMLElement* child = joint.xml().FirstChildElement(tag);
  std::string_view text = child && child->GetText() ? child->GetText() : "";
  std::string_view name = next_word(text);
  if (const std::size_t scope = name.rfind("::"); scope != std::string_view::npos) name.remove_prefix(scope + 2);
  return std::string(name);
}

}  // namespace

void warn_of_strangers(const XmlElement& robot, const std::vector<ForceElementKind>& kinds) {
  std::vector<std::string_view> own(std::begin(kOwn), std::end(kOwn));
  for (const ForceElementKind& kind : kinds) own.push_back(kind.tag);
  std::set<std::string> told;
  for (const XmlElement& child : robot.children()) {
    if (is_contact(child)) continue;
    const std::string advice = advice_for(child.tag(), own);
    if (!advice.empty() && told.insert(child.tag()).second) child.warning(advice);
  }
}

void warn_of_gazebo_loops(const XmlElement& robot, const SceneDescription& scene) {
  std::set<std::string> names;
  for (const LinkDescription& link : scene.links) names.insert(link.name);
  const auto are_joined = [&](const std::string& one, const std::string& other) {
    const auto joins = [&](const JointDescription& joint) {
      return (joint.parent == one && joint.child == other) || (joint.parent == other && joint.child == one);
    };
    return std::any_of(scene.joints.begin(), scene.joints.end(), joins) ||
           std::any_of(scene.loop_joints.begin(), scene.loop_joints.end(), joins);
  };
  for (const XmlElement& gazebo : robot.children()) {
    if (gazebo.tag() != "gazebo") continue;
    for (const XmlElement& joint : gazebo.children()) {
      if (joint.tag() != "joint") continue;
      const std::string parent = link_in(joint, "parent"), child = link_in(joint, "child");
      if (names.count(parent) == 0 || names.count(child) == 0 || are_joined(parent, child)) continue;
      joint.with_name(joint.has("name") ? joint.text("name").value_or("") : "")
          .warning("closes a loop in Gazebo alone, between the links " + quoted(parent) + " and " + quoted(child) +
                   ": a <loop_joint> of <robot>, which Gazebo overlooks, closes it here");
    }
  }
}

}  // namespace flexarm::scene
