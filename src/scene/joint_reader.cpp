#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "math/number_text.h"
#include "math/pi.h"
#include "scene/joint_kinds.h"
#include "scene/readers.h"
#include "scene/standard_attributes.h"
#include "scene/standard_reader.h"
#include "scene/urdfdom.h"

namespace flexarm::scene {
namespace {

constexpr StandardAttribute kJointAttributes[] = {
    {"origin", "xyz", 3, false, kModerate},
    {"origin", "rpy", 3, false, kModerate},
};
constexpr StandardAttribute kMovableAttributes[] = {
    {"limit", "effort", 1, false, kAnyNumber},        {"dynamics", "damping", 1, false, kNonNegative},
    {"dynamics", "friction", 1, false, kNonNegative}, {"mimic", "multiplier", 1, false, kAnyNumber},
    {"mimic", "offset", 1, false, kAnyNumber},
};
constexpr StandardAttribute kRangeAttributes[] = {
    {"limit", "lower", 1, false, kAnyNumber},
    {"limit", "upper", 1, false, kAnyNumber},
};

/// The kind that an attribute names. If it is missing or unknown, records an error and returns nothing.
std::optional<JointKind> read_kind(const XmlElement& element, const char* attribute,
                                   const std::vector<JointKindName>& names) {
  const JointKindName* row = read_row(element, attribute, names);
  return row ? std::optional<JointKind>(row->kind) : std::nullopt;
}

/// Reads the kind of a joint from `type` and <release>. For <couple> and <slide> the exact kind is read with their
/// data.
std::optional<JointKind> read_joint_kind(const XmlElement& joint) {
  const std::optional<JointKind> type = read_kind(joint, "type", joint_types());
  std::vector<XmlElement> narrowing;
  for (const char* tag : {"release", "couple", "slide"})
    if (const std::optional<XmlElement> child = joint.child(tag)) narrowing.push_back(*child);
  if (narrowing.empty()) return type;
  if (narrowing.size() > 1) narrowing.back().error("a joint has one of <release>, <couple>, <slide>");
  const XmlElement& first = narrowing.front();
  if (type && *type != JointKind::Floating) {
    first.error("the type of the joint must be 'floating'", quoted(joint.text("type").value_or("")));
    return std::nullopt;
  }
  // Preliminary, until read_couple() sets the kind: any kind with an axis.
  if (first.tag() == "couple") return JointKind::Screw;
  if (first.tag() == "slide") return JointKind::Slide;
  first.expect_only({"kind"});
  return read_kind(first, "kind", joint_releases());
}

/// "universal or ...".
std::string kinds_with_two_axes() {
  std::string out;
  for (const JointKindTraits& traits : joint_kinds())
    if (traits.axes == 2) out += (out.empty() ? "" : " or ") + std::string(traits.release);
  return out;
}

void read_axes(const XmlElement& joint, JointDescription& description) {
  const std::optional<XmlElement> axis = joint.child("axis"), axis2 = joint.child("axis2");
  // The <axis> of a joint that uses none is ignored: exporters give fixed joints the axis 0 0 0.
  if (axis && traits_of(description.kind).axes > 0)
    description.axis = axis->direction("xyz").value_or(description.axis);
  const bool is_coupled_slide = description.slide && has_dependent_travel(description.slide->rotation);
  if (joint.child("couple") || is_coupled_slide) {
    if (!axis && !is_coupled_slide)
      joint.error("a joint with <couple> needs the axis of its angle, <axis xyz=\"...\"/>");
    return;
  }
  const JointKindTraits& turning = traits_of(description.slide ? description.slide->rotation : description.kind);
  if (turning.axes < 2) {
    if (axis2)
      axis2->error(fmt::format("only a joint with <release> of kind {} has a second axis", kinds_with_two_axes()));
    return;
  }
  if (!axis2) {
    joint.error(fmt::format("a {} joint needs a second axis, <axis2 xyz=\"...\"/>", turning.name));
    return;
  }
  axis2->expect_only({"xyz"});
  const std::optional<Vector3> direction = axis2->direction("xyz");
  if (!direction) return;
  description.axis2 = *direction;
  if (direction->cross(description.axis).norm() < 1e-6)
    axis2->attribute_error("xyz", fmt::format("the axes of a {} joint must not be parallel", turning.name));
}

/// Reads a limit. Returns 0, which means no limit, if the attribute is missing or below 0. A value below 0 means no
/// limit in SDF, so it only gives a warning.
double read_unlimited(const XmlElement& limit, const char* attribute) {
  const tinyxml2::XMLAttribute* found = limit.xml().FindAttribute(attribute);
  std::string_view text = found ? found->Value() : "";
  const double number = parse_number(next_word(text)).value_or(0);
  if (!(number < 0)) return number;
  limit.warning(fmt::format("{} below 0 is read as no limit", attribute), limit.findings().got(*found));
  return 0;
}

/// Warns of limits of an angle that look like degrees: whole numbers, of several turns if they were radians.
void warn_of_degrees(const XmlElement& limit, JointKind kind, double lower, double upper) {
  constexpr double kLeast = 30, kMost = 720;
  const double largest = std::max(std::abs(lower), std::abs(upper));
  const bool are_whole = lower == std::round(lower) && upper == std::round(upper);
  if (kind != JointKind::Revolute || largest < kLeast || largest > kMost || !are_whole) return;
  limit.warning(fmt::format("lower and upper look like degrees, but are in rad, and so {:.3g} turns apart",
                            (upper - lower) / (2 * kPi)),
                fmt::format("lower '{}', upper '{}'", lower, upper));
}

void read_limits(const XmlElement& joint, JointDescription& description) {
  const std::optional<XmlElement> limit = joint.child("limit");
  if (!limit || description.kind == JointKind::Fixed || joint.child("clearance")) return;
  description.effort_limit = read_unlimited(*limit, "effort");
  const double velocity = read_unlimited(*limit, "velocity");
  if (!traits_of(description.kind).may_have_stops) return;
  double lower = limit->number("lower", kAnyNumber, 0), upper = limit->number("upper", kAnyNumber, 0);
  if (has_dependent_travel(description.kind) && lower == upper) return;  // <limit> is given for its effort only
  if (lower > upper) {
    limit->warning("lower must be <= upper: the two are exchanged",
                   fmt::format("lower '{}', upper '{}'", lower, upper));
    std::swap(lower, upper);
  }
  warn_of_degrees(*limit, description.kind, lower, upper);
  if (lower == upper) limit->warning("lower and upper are equal: the joint cannot move");
  description.limits = JointLimits{lower, upper, velocity, std::nullopt};
  if (limit->has("restitution")) description.limits->restitution = limit->number("restitution", kRestitution);
  read_hardness(*limit, description.limits->contact_time, description.limits->stiffness);
}

/// Reads <mimic>. Exporters leave it on joints that they have made fixed, so there it only gives a warning.
std::optional<Mimic> read_mimic(const XmlElement& mimic, JointKind kind) {
  if (kind == JointKind::Fixed) {
    mimic.warning("is ignored: a fixed joint has no coordinate that could follow another");
    return std::nullopt;
  }
  return Mimic{mimic.name("joint").value_or(""), mimic.number("multiplier", kAnyNumber, 1),
               mimic.number("offset", kAnyNumber, 0)};
}

bool is_fixed(const XmlElement& joint) {
  return joint.has("type") && std::string_view(joint.xml().Attribute("type")) == "fixed";
}

/// Checks the children of a joint. Skips children without effect: axis, limits, dynamics and mimic of a fixed joint,
/// and the range of a joint without stops.
void check_joint_structure(const XmlElement& joint) {
  joint.expect_at_most_one({"parent", "child", "axis2", "release", "couple", "friction", "child_origin", "clearance"});
  joint.expect_first_counts({"origin"});
  check_attributes(joint, kJointAttributes);
  if (is_fixed(joint)) return;
  joint.expect_first_counts({"axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"});
  check_attributes(joint, kMovableAttributes);
  const std::string type = joint.xml().Attribute("type") ? joint.xml().Attribute("type") : "";
  const bool has_range = type == "revolute" || type == "prismatic";
  if (has_range || joint.child("couple")) check_attributes(joint, kRangeAttributes);
  if (has_range && !joint.child("limit") && !joint.child("clearance"))
    joint.warning("<limit lower=\"...\" upper=\"...\" effort=\"...\" velocity=\"...\"/> is missing: the " + type +
                  " joint has no stops");
}

/// Returns the name of the link in <parent> or <child>. If it is missing, records an error and returns an empty text.
std::string read_link_name(const XmlElement& joint, const char* tag) {
  const std::optional<XmlElement> child = joint.child(tag);
  if (!child) joint.error("<" + std::string(tag) + " link=\"...\"/> is missing");
  return child ? child->name("link").value_or("") : "";
}

/// Returns the XML text of a <joint> between links named "parent" and "child", so that urdfdom can judge it
/// without the rest of the file.
std::string printed_joint(const XmlElement& joint) {
  tinyxml2::XMLDocument document;
  tinyxml2::XMLElement* copy = joint.xml().DeepClone(&document)->ToElement();
  document.InsertEndChild(copy);
  for (const char* tag : {"parent", "child"}) copy->FirstChildElement(tag)->SetAttribute("link", tag);
  return printed(*copy);
}

}  // namespace

JointDescription read_joint(const XmlElement& unnamed) {
  JointDescription description;
  description.name = unnamed.name("name").value_or("");
  description.location = unnamed.location();
  const XmlElement joint = unnamed.with_name(description.name);
  const std::size_t errors = joint.findings().error_count();
  description.parent = read_link_name(joint, "parent");
  description.child = read_link_name(joint, "child");
  check_joint_structure(joint);
  if (const std::optional<JointKind> kind = read_joint_kind(joint)) {
    description.kind = *kind;
    if (const std::optional<XmlElement> slide = joint.child("slide"); slide && *kind == JointKind::Slide)
      read_slide(joint, *slide, description);
    read_axes(joint, description);
    if (const std::optional<XmlElement> couple = joint.child("couple")) read_couple(joint, *couple, description);
    if (const std::optional<XmlElement> friction = joint.child("friction")) read_friction(*friction, description);
  }
  const std::optional<XmlElement> mimic = joint.child("mimic");
  if (mimic && !mimic->has("joint") && !is_fixed(joint)) mimic->error("attribute 'joint' is missing");
  if (joint.findings().error_count() > errors) return description;

  if (joint.tag() == "joint")  // no other program reads a <loop_joint>
    judge_alone(joint, "<link name=\"parent\"/><link name=\"child\"/>" + printed_joint(joint));
  description.origin = read_origin(joint);
  if (description.kind != JointKind::Fixed) {
    description.damping = checked_number(joint, "dynamics", "damping");
    description.friction = checked_number(joint, "dynamics", "friction");
  }
  if (mimic) description.mimic = read_mimic(*mimic, description.kind);
  read_limits(joint, description);
  return description;
}

void read_travel(const XmlElement& element, JointDescription& description, const NumberRange& positions) {
  element.expect_at_most_one({"limit", "dynamics", "friction"});
  check_attributes(element, kMovableAttributes);
  if (const std::optional<XmlElement> dynamics = element.child("dynamics"))
    dynamics->expect_only({"damping", "friction"});
  description.damping = checked_number(element, "dynamics", "damping");
  description.friction = checked_number(element, "dynamics", "friction");
  if (const std::optional<XmlElement> friction = element.child("friction")) read_friction(*friction, description);
  const std::optional<XmlElement> limit = element.child("limit");
  if (!limit) return;
  limit->expect_only({"lower", "upper", "effort", "velocity", "restitution", "contact_time", "stiffness"});
  if (limit->has("lower") || limit->has("upper")) {
    const std::optional<double> lower = limit->number("lower", positions), upper = limit->number("upper", positions);
    if (lower && upper && *lower > *upper)
      limit->error("lower must be <= upper", fmt::format("lower '{}', upper '{}'", *lower, *upper));
    else if (lower && upper)
      read_limits(element, description);
    return;
  }
  description.effort_limit = read_unlimited(*limit, "effort");
  for (const char* attribute : {"restitution", "contact_time", "stiffness"})
    if (limit->has(attribute)) limit->attribute_error(attribute, "there are no stops without lower and upper");
}

namespace {

/// Reads <link1> or <link2> of a loop joint in the form of Drake and Isaac Sim. Sets `link` to the name of the link,
/// and returns the pose of the joint frame in the link frame.
Pose read_side(const XmlElement& joint, const char* tag, std::string& link) {
  const std::optional<XmlElement> side = joint.child(tag);
  if (!side) {
    joint.error("<" + std::string(tag) + " link=\"...\" xyz=\"...\" rpy=\"...\"/> is missing");
    return Pose();
  }
  side->expect_only({"link", "xyz", "rpy"});
  link = side->name("link").value_or("");
  return read_pose(*side);
}

/// Reads a <loop_joint> with <link1> and <link2>.
JointDescription read_foreign_loop_joint(const XmlElement& joint) {
  JointDescription description;
  joint.expect_only({"name", "type"}, {"link1", "link2", "axis"});
  joint.expect_at_most_one({"link1", "link2", "axis"});
  description.origin = read_side(joint, "link1", description.parent);
  description.child_origin = read_side(joint, "link2", description.child);
  description.kind =
      joint.has("type") ? read_kind(joint, "type", joint_types()).value_or(JointKind::Spherical) : JointKind::Spherical;
  read_axes(joint, description);
  const std::string type = joint.has("type") ? joint.text("type").value_or("") : "spherical";
  joint.warning("<link1> and <link2>, the form of Drake and Isaac Sim, are read as a loop joint of type " +
                quoted(type) + " with <parent> and <origin>, <child> and <child_origin>");
  return description;
}

}  // namespace

JointDescription read_loop_joint(const XmlElement& unnamed) {
  const XmlElement joint = unnamed.with_name(unnamed.text("name").value_or(""));
  const std::size_t errors = joint.findings().error_count();
  JointDescription description;
  if (joint.child("link1") || joint.child("link2")) {
    description = read_foreign_loop_joint(joint);
  } else {
    for (const char* tag : {"slide", "mimic"})
      if (const std::optional<XmlElement> child = joint.child(tag))
        child->error("a <loop_joint> cannot have a <" + std::string(tag) + ">");
    joint.expect_only({"name", "type"}, {"origin", "parent", "child", "axis", "axis2", "limit", "dynamics", "mimic",
                                         "release", "couple", "slide", "friction", "child_origin", "clearance"});
    if (joint.findings().error_count() == errors) description = read_joint(unnamed);
  }
  description.name = unnamed.text("name").value_or("");
  description.location = unnamed.location();
  if (const std::optional<XmlElement> origin = joint.child("child_origin")) {
    origin->expect_only({"xyz", "rpy"});
    description.child_origin = read_pose(*origin);
  }
  if (description.kind == JointKind::Floating && joint.findings().error_count() == errors)
    joint.error("a <loop_joint> must constrain something: type 'floating' and <release kind=\"free\"/> do not");
  return description;
}

}  // namespace flexarm::scene
