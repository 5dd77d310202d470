#include "scene/standard_reader.h"

#include "scene/choice.h"
#include "scene/couple_reader.h"
#include "scene/friction_reader.h"
#include "scene/slide_reader.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "scene/urdfdom.h"

namespace flexarm::scene {
namespace {

/// `count` numbers in an attribute of a child element.
struct StandardAttribute {
  const char* child;
  const char* attribute;
  std::size_t count;
  bool required;  // where the child is there
  NumberRange range;
};

constexpr StandardAttribute kInertialAttributes[] = {
    {"origin", "xyz", 3, false, kAnyNumber},   {"origin", "rpy", 3, false, kAnyNumber},
    {"mass", "value", 1, true, kNonNegative},  {"inertia", "ixx", 1, true, kNonNegative},
    {"inertia", "ixy", 1, true, kAnyNumber},   {"inertia", "ixz", 1, true, kAnyNumber},
    {"inertia", "iyy", 1, true, kNonNegative}, {"inertia", "iyz", 1, true, kAnyNumber},
    {"inertia", "izz", 1, true, kNonNegative},
};

constexpr StandardAttribute kJointAttributes[] = {
    {"origin", "xyz", 3, false, kAnyNumber},
    {"origin", "rpy", 3, false, kAnyNumber},
    {"limit", "lower", 1, false, kAnyNumber},
    {"limit", "upper", 1, false, kAnyNumber},
    {"limit", "effort", 1, true, kNonNegative},
    {"limit", "velocity", 1, true, kNonNegative},
    {"dynamics", "damping", 1, false, kNonNegative},
    {"dynamics", "friction", 1, false, kNonNegative},
    {"mimic", "multiplier", 1, false, kAnyNumber},
    {"mimic", "offset", 1, false, kAnyNumber},
    {"safety_controller", "soft_lower_limit", 1, false, kAnyNumber},
    {"safety_controller", "soft_upper_limit", 1, false, kAnyNumber},
    {"safety_controller", "k_position", 1, false, kAnyNumber},
    {"safety_controller", "k_velocity", 1, true, kAnyNumber},
    {"calibration", "rising", 1, false, kAnyNumber},
    {"calibration", "falling", 1, false, kAnyNumber},
};

template <std::size_t Count>
void check_attributes(const XmlElement& element, const StandardAttribute (&table)[Count]) {
  for (const StandardAttribute& row : table) {
    const std::optional<XmlElement> child = element.child(row.child);
    if (child && (row.required || child->has(row.attribute))) child->numbers(row.attribute, row.count, row.range);
  }
}

Vector3 from_urdf(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

Pose from_urdf(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return {from_urdf(pose.position), Quaternion(q.w, q.x, q.y, q.z).normalized()};
}

/// Has urdfdom read a document with only these elements of <robot>; its complaints become a finding about `element`.
urdf::ModelInterfaceSharedPtr read_alone(const XmlElement& element, const std::string& elements) {
  const UrdfdomResult result = parse_with_urdfdom("<robot name=\"robot\">" + elements + "</robot>");
  if (!result.errors.empty()) element.error("must be valid URDF", quoted(result.errors.front()));
  return result.errors.empty() ? result.model : nullptr;
}

// ---------------------------------------------------------------- links

/// A real body's inertia: positive semidefinite, and no principal moment larger than the sum of the others.
void check_inertia(const XmlElement& inertial, const Matrix3& inertia) {
  const Vector3 moments = Eigen::SelfAdjointEigenSolver<Matrix3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double tolerance = 1e-9 * moments.cwiseAbs().maxCoeff();
  const XmlElement element = inertial.child("inertia").value_or(inertial);
  if (moments[0] < -tolerance) {
    element.error("principal moments of inertia must be >= 0", fmt::format("'{}'", moments[0]));
  } else if (moments[2] > moments[0] + moments[1] + tolerance) {
    element.warning("no body has a principal moment of inertia larger than the sum of the others");
  }
}

std::optional<RigidInertia> read_inertial(const XmlElement& inertial) {
  const std::size_t errors = inertial.findings().error_count();
  inertial.expect_at_most_one({"origin", "mass", "inertia"});
  for (const char* tag : {"mass", "inertia"})
    if (!inertial.child(tag)) inertial.error("<" + std::string(tag) + "> is missing");
  check_attributes(inertial, kInertialAttributes);
  if (inertial.findings().error_count() > errors) return std::nullopt;

  const urdf::ModelInterfaceSharedPtr model =
      read_alone(inertial, "<link name=\"link\">" + printed(inertial.xml()) + "</link>");
  if (!model || !model->getRoot() || !model->getRoot()->inertial) return std::nullopt;
  const urdf::Inertial& read = *model->getRoot()->inertial;
  Matrix3 inertia;
  inertia << read.ixx, read.ixy, read.ixz, read.ixy, read.iyy, read.iyz, read.ixz, read.iyz, read.izz;
  check_inertia(inertial, inertia);
  const Pose frame = from_urdf(read.origin);
  const Matrix3 rotation = frame.orientation.toRotationMatrix();
  return RigidInertia{read.mass, frame.position, rotation * inertia * rotation.transpose()};
}

// ---------------------------------------------------------------- joints

constexpr Choice<JointKind> kTypes[] = {{"fixed", JointKind::Fixed},           {"revolute", JointKind::Revolute},
                                        {"continuous", JointKind::Continuous}, {"prismatic", JointKind::Prismatic},
                                        {"planar", JointKind::Planar},         {"floating", JointKind::Floating}};
constexpr Choice<JointKind> kReleases[] = {{"spherical", JointKind::Spherical},
                                           {"universal", JointKind::Universal},
                                           {"cylindrical", JointKind::Cylindrical},
                                           {"planar", JointKind::Planar},
                                           {"free", JointKind::Floating}};

/// The kind, after looking at <release>. Those of <couple> and <slide> are read with their data.
std::optional<JointKind> read_joint_kind(const XmlElement& joint) {
  const std::optional<JointKind> type = read_choice(joint, "type", kTypes);
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
  if (first.tag() == "couple") return JointKind::Screw;  // until it is read: one with an axis
  if (first.tag() == "slide") return JointKind::Slide;
  first.expect_only({"kind"});
  return read_choice(first, "kind", kReleases);
}

bool uses_axis(JointKind kind) {
  return kind != JointKind::Fixed && kind != JointKind::Floating && kind != JointKind::Spherical;
}

void read_axes(const XmlElement& joint, JointDescription& description) {
  const std::optional<XmlElement> axis = joint.child("axis"), axis2 = joint.child("axis2");
  if (axis && uses_axis(description.kind)) {
    description.axis = axis->direction("xyz").value_or(description.axis);
  } else if (axis) {
    axis->vector("xyz");  // exporters give fixed joints the axis 0 0 0
  }
  const bool is_coupled_slide = description.slide && has_dependent_travel(description.slide->rotation);
  if (joint.child("couple") || is_coupled_slide) {
    if (!axis && !is_coupled_slide)
      joint.error("a joint with <couple> needs the axis of its angle, <axis xyz=\"...\"/>");
    return;
  }
  const bool is_universal = description.kind == JointKind::Universal ||
                            (description.slide && description.slide->rotation == JointKind::Universal);
  if (!is_universal) {
    if (axis2) axis2->error("only a joint with <release kind=\"universal\"/> has a second axis");
    return;
  }
  if (!axis2) {
    joint.error("a universal joint needs a second axis, <axis2 xyz=\"...\"/>");
    return;
  }
  axis2->expect_only({"xyz"});
  const std::optional<Vector3> direction = axis2->direction("xyz");
  if (!direction) return;
  description.axis2 = *direction;
  if (direction->cross(description.axis).norm() < 1e-6)
    axis2->attribute_error("xyz", "the axes of a universal joint must not be parallel");
}

void read_limits(const XmlElement& joint, const urdf::Joint& read, JointDescription& description) {
  if (!read.limits) return;
  const urdf::JointLimits& limits = *read.limits;
  description.effort_limit = limits.effort;
  if (has_dependent_travel(description.kind) && limits.lower == limits.upper) return;  // given for effort only
  if (description.kind != JointKind::Revolute && description.kind != JointKind::Prismatic &&
      !has_dependent_travel(description.kind))
    return;
  const XmlElement element = joint.child("limit").value_or(joint);
  if (limits.lower > limits.upper)
    element.error("lower must be <= upper", fmt::format("lower '{}', upper '{}'", limits.lower, limits.upper));
  if (limits.lower == limits.upper) element.warning("lower and upper are equal: the joint cannot move");
  description.limits = JointLimits{limits.lower, limits.upper, limits.velocity};
}

void check_joint_structure(const XmlElement& joint) {
  joint.expect_at_most_one({"origin", "parent", "child", "axis", "axis2", "limit", "dynamics", "mimic", "release",
                            "couple", "friction", "child_origin", "safety_controller", "calibration"});
  check_attributes(joint, kJointAttributes);
  const std::string type = joint.xml().Attribute("type") ? joint.xml().Attribute("type") : "";
  if ((type == "revolute" || type == "prismatic") && !joint.child("limit"))
    joint.error("a " + type + " joint needs <limit effort=\"...\" velocity=\"...\" lower=\"...\" upper=\"...\"/>");
}

/// Name of the link in <parent> or <child>; empty if there is none, which is recorded.
std::string read_link_name(const XmlElement& joint, const char* tag) {
  const std::optional<XmlElement> child = joint.child(tag);
  if (!child) joint.error("<" + std::string(tag) + " link=\"...\"/> is missing");
  return child ? child->text("link").value_or("") : "";
}

/// As a <joint> between stand-ins for its links, which keep urdfdom from complaining about the rest of the file.
std::string printed_joint(const XmlElement& joint) {
  tinyxml2::XMLDocument document;
  tinyxml2::XMLElement* copy = joint.xml().DeepClone(&document)->ToElement();
  document.InsertEndChild(copy);
  copy->SetName("joint");
  for (const char* tag : {"parent", "child"}) copy->FirstChildElement(tag)->SetAttribute("link", tag);
  return printed(*copy);
}

Pose read_child_origin(const XmlElement& origin) {
  origin.expect_only({"xyz", "rpy"});
  const Vector3 rpy = origin.vector("rpy", Vector3::Zero());
  urdf::Rotation rotation;
  rotation.setFromRPY(rpy.x(), rpy.y(), rpy.z());
  const Vector3 xyz = origin.vector("xyz", Vector3::Zero());
  return {xyz, Quaternion(rotation.w, rotation.x, rotation.y, rotation.z).normalized()};
}

}  // namespace

void check_with_urdfdom(const XmlElement& element) {
  read_alone(element, printed(element.xml()) + "<link name=\"link\"/>");
}

LinkDescription read_link(const XmlElement& unnamed) {
  LinkDescription description;
  description.name = unnamed.name("name").value_or("");
  description.location = unnamed.location();
  const XmlElement link = unnamed.with_name(description.name);
  link.expect_at_most_one({"inertial", "beam"});
  if (const std::optional<XmlElement> inertial = link.child("inertial"))
    description.inertial = read_inertial(*inertial);
  // Each alone, since urdfdom leaves a link at its first error.
  for (const XmlElement& child : link.children())
    if (child.tag() == "visual" || child.tag() == "collision")
      read_alone(child, "<link name=\"link\">" + printed(child.xml()) + "</link>");
  return description;
}

JointDescription read_joint(const XmlElement& unnamed) {
  JointDescription description;
  description.name = unnamed.name("name").value_or("");
  description.location = unnamed.location();
  const XmlElement joint = unnamed.with_name(description.name);
  const std::size_t errors = joint.findings().error_count();
  description.parent = read_link_name(joint, "parent");
  description.child = read_link_name(joint, "child");
  if (const std::optional<XmlElement> mimic = joint.child("mimic"))
    description.mimic = Mimic{mimic->text("joint").value_or("")};
  check_joint_structure(joint);
  if (const std::optional<JointKind> kind = read_joint_kind(joint)) {
    description.kind = *kind;
    if (const std::optional<XmlElement> slide = joint.child("slide"); slide && *kind == JointKind::Slide)
      read_slide(joint, *slide, description);
    read_axes(joint, description);
    if (const std::optional<XmlElement> couple = joint.child("couple")) read_couple(joint, *couple, description);
    if (const std::optional<XmlElement> friction = joint.child("friction")) read_friction(*friction, description);
  }
  if (joint.findings().error_count() > errors) return description;

  const urdf::ModelInterfaceSharedPtr model =
      read_alone(joint, "<link name=\"parent\"/><link name=\"child\"/>" + printed_joint(joint));
  const urdf::JointConstSharedPtr read = model ? model->getJoint(description.name) : nullptr;
  if (!read) return description;
  description.origin = from_urdf(read->parent_to_joint_origin_transform);
  if (read->dynamics) {
    description.damping = read->dynamics->damping;
    description.friction = read->dynamics->friction;
  }
  if (read->mimic) description.mimic = Mimic{read->mimic->joint_name, read->mimic->multiplier, read->mimic->offset};
  read_limits(joint, *read, description);
  return description;
}

JointDescription read_loop_joint(const XmlElement& unnamed) {
  const XmlElement joint = unnamed.with_name(unnamed.text("name").value_or(""));
  const std::size_t errors = joint.findings().error_count();
  for (const char* tag : {"slide", "mimic"})
    if (const std::optional<XmlElement> child = joint.child(tag))
      child->error("a <loop_joint> cannot have a <" + std::string(tag) + ">");
  joint.expect_only({"name", "type"}, {"origin", "parent", "child", "axis", "axis2", "limit", "dynamics", "mimic",
                                       "release", "couple", "slide", "friction", "child_origin"});
  JointDescription description;
  if (joint.findings().error_count() == errors) description = read_joint(unnamed);
  description.name = unnamed.text("name").value_or("");
  description.location = unnamed.location();
  if (const std::optional<XmlElement> origin = joint.child("child_origin"))
    description.child_origin = read_child_origin(*origin);
  if (description.kind == JointKind::Floating && joint.findings().error_count() == errors)
    joint.error("a <loop_joint> must hold something: not 'floating' alone, nor <release kind=\"free\"/>");
  return description;
}

}  // namespace flexarm::scene
