#include "scene/strangers.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include "flexarm/math/near_names.h"
#include "math/number_text.h"
#include "scene/limits.h"
#include "scene/readers.h"

namespace flexarm::scene {
namespace {

/// Children of <robot> that flexarm or URDF knows. A misspelt name is compared with these.
constexpr std::string_view kOwn[] = {"link",   "joint",        "material",   "loop_joint", "spring",    "drive",
                                     "servo",  "transmission", "simulation", "sensor",     "parameter", "gazebo",
                                     "ground", "no_contact",   "cylinder",   "winch"};
/// Children of <robot> that other programs read. The comments name some of these programs.
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
/// flexarm's elements that are not children of <robot>. check_places() in urdf_reader.cpp records an error for them.
constexpr std::string_view kPlaced[] = {"beam",     "release", "axis2", "slide",     "couple", "child_origin",
                                        "friction", "root",    "hub",   "clearance", "drag"};
/// The attributes and children of an element of URDF, with those that flexarm adds. <simulation> is here only to say
/// where its children belong: its reader checks its attributes.
struct Words {
  std::string_view tag, attributes, children;
};
constexpr Words kWords[] = {
    {"link", "name type", "inertial visual collision contact beam drag"},
    {"joint", "name type",
     "origin parent child axis limit dynamics mimic safety_controller calibration axis2 slide couple release friction "
     "clearance"},
    {"inertial", "", "origin mass inertia"},
    {"visual", "name", "origin geometry material"},
    {"collision", "name", "origin geometry"},
    {"geometry", "", "box cylinder sphere mesh capsule"},
    {"material", "name", "color texture"},
    {"origin", "xyz rpy", ""},
    {"axis", "xyz", ""},
    {"mass", "value", ""},
    {"inertia", "ixx ixy ixz iyy iyz izz", ""},
    {"limit", "lower upper effort velocity restitution contact_time stiffness", ""},
    {"dynamics", "damping friction", ""},
    {"mimic", "joint multiplier offset", ""},
    {"safety_controller", "soft_lower_limit soft_upper_limit k_position k_velocity", ""},
    {"calibration", "rising falling reference_position", ""},
    {"parent", "link", ""},
    {"child", "link", ""},
    {"box", "size", ""},
    {"cylinder", "radius length inner_radius", ""},
    {"sphere", "radius", ""},
    {"mesh", "filename scale", ""},
    {"color", "rgba", ""},
    {"texture", "filename", ""},
    {"simulation", "", "gravity integrator initial load distributed_load motion effort probe"},
};

const Words* words_of(std::string_view tag) {
  const auto row = std::find_if(std::begin(kWords), std::end(kWords), [&](const Words& it) { return it.tag == tag; });
  return row == std::end(kWords) ? nullptr : row;
}

std::vector<std::string_view> split(std::string_view words) {
  std::vector<std::string_view> out;
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) out.push_back(word);
  return out;
}

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

/// Returns the known name that a misspelt one probably means: the nearest one, if at most a third of the letters
/// differ. Upper case counts as lower case. Empty if there is none.
std::string_view nearest(std::string_view name, const std::vector<std::string_view>& known) {
  std::string_view best;
  int least = static_cast<int>(name.size()) / 3 + 1;
  if (name.size() > 2 * kLongestParameterName) return best;  // too long for any known name; saves a costly comparison
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const std::string_view each : known) {
    const int count = misspellings(lower, each);
    if (count >= least) continue;
    least = count;
    best = each;
  }
  return best;
}

/// Returns the text of the warning about an element; empty if the element is known.
std::string advice_for(std::string_view tag, const std::vector<std::string_view>& own) {
  if (tag.find(':') != std::string_view::npos || contains(own, tag) || contains(kPlaced, tag) ||
      contains(kOfOthers, tag))
    return {};
  for (const char* parent : {"link", "joint", "simulation"})
    if (contains(split(words_of(parent)->children), tag))
      return "has no effect here: it belongs in <" + std::string(parent) + ">";
  const std::string_view meant = nearest(tag, own);
  return "has no effect: no known program uses it here" +
         (meant.empty() ? std::string() : "; is <" + std::string(meant) + "> meant?");
}

/// Warns of misspelt words in an element of URDF and in all elements of URDF below it.
class WordCheck {
 public:
  void check(const XmlElement& element) {
    if (const Words* words = words_of(element.tag())) {
      const std::vector<std::string_view> attributes = split(words->attributes), children = split(words->children);
      for (const tinyxml2::XMLAttribute* a = element.xml().FirstAttribute(); a; a = a->Next()) {
        const std::string meant = meant_by(a->Name(), attributes);
        if (!meant.empty() && told_.emplace(words->tag, std::string("@") + a->Name()).second)
          element.findings().warning(a->GetLineNum(), element.description(),
                                     "unknown attribute; is '" + meant + "' meant?", quoted(a->Name()));
      }
      for (const XmlElement& child : element.children()) {
        const std::string meant = meant_by(child.tag(), children);
        if (!meant.empty() && told_.emplace(words->tag, child.tag()).second)
          child.warning("has no effect: <" + element.tag() + "> has no such child; is <" + meant + "> meant?");
      }
    }
    for (const XmlElement& child : element.children())
      if (words_of(child.tag())) check(child);
  }

 private:
  /// Returns the word that is probably meant; empty if the name is a word, or near to none, or has a namespace.
  static std::string meant_by(std::string_view name, const std::vector<std::string_view>& words) {
    if (contains(words, name) || name.find(':') != std::string_view::npos) return {};
    return std::string(nearest(name, words));
  }

  std::set<std::pair<std::string_view, std::string>> told_;  // tag of the parent, and name; attributes begin with '@'
};

/// Returns the name of a link in the text of <parent> or <child>, as Gazebo writes it ("MODEL::LINK"), without the
/// model's name.
std::string link_in(const XmlElement& joint, const char* tag) {
  const tinyxml2::XMLElement* child = joint.xml().FirstChildElement(tag);
  std::string_view text = child && child->GetText() ? child->GetText() : "";
  std::string_view name = next_word(text);
  if (const std::size_t scope = name.rfind("::"); scope != std::string_view::npos) name.remove_prefix(scope + 2);
  return std::string(name);
}

}  // namespace

bool belongs_in_simulation(const XmlElement& element) {
  return contains(split(words_of("simulation")->children), std::string_view(element.tag())) &&
         (element.has("joint") || element.has("link"));
}

void warn_of_strangers(const XmlElement& robot, const std::vector<ForceElementKind>& kinds) {
  std::vector<std::string_view> own(std::begin(kOwn), std::end(kOwn));
  for (const ForceElementKind& kind : kinds) own.push_back(kind.tag);
  std::set<std::string> told;
  for (const XmlElement& child : robot.children()) {
    if (is_contact(child) || belongs_in_simulation(child)) continue;
    const std::string advice = advice_for(child.tag(), own);
    if (!advice.empty() && told.insert(child.tag()).second) child.warning(advice);
  }
}

void warn_of_misspelt_words(const XmlElement& robot) {
  WordCheck words;
  for (const XmlElement& child : robot.children())
    for (const char* tag : {"link", "joint", "loop_joint", "material"})
      if (child.tag() == tag) words.check(child.with_name(child.has("name") ? child.text("name").value_or("") : ""));
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
          .warning("closes a loop in Gazebo only, between the links " + quoted(parent) + " and " + quoted(child) +
                   ": a <loop_joint> of <robot>, which Gazebo ignores, closes it in flexarm");
    }
  }
}

}  // namespace flexarm::scene
