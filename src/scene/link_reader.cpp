#include <fmt/format.h>

#include "scene/readers.h"
#include "scene/standard_attributes.h"
#include "scene/standard_reader.h"
#include "scene/urdfdom.h"

namespace flexarm::scene {
namespace {

constexpr StandardAttribute kInertialAttributes[] = {
    {"origin", "xyz", 3, false, kModerate},   {"origin", "rpy", 3, false, kModerate},
    {"mass", "value", 1, true, kNonNegative}, {"inertia", "ixx", 1, true, kModerate},
    {"inertia", "ixy", 1, true, kModerate},   {"inertia", "ixz", 1, true, kModerate},
    {"inertia", "iyy", 1, true, kModerate},   {"inertia", "iyz", 1, true, kModerate},
    {"inertia", "izz", 1, true, kModerate},
};

std::optional<RigidInertia> read_inertial(const XmlElement& inertial) {
  const std::size_t errors = inertial.findings().error_count();
  inertial.expect_first_counts({"origin", "mass", "inertia"});
  if (!inertial.child("mass")) inertial.error("<mass> is missing");
  check_attributes(inertial, kInertialAttributes);
  if (inertial.findings().error_count() > errors) return std::nullopt;

  const std::optional<XmlElement> rotary = inertial.child("inertia");
  if (!rotary) inertial.warning("<inertia> is missing: its mass is a point");

  judge_alone(inertial, "<link name=\"link\">" + printed(inertial.xml()) + "</link>");
  const auto moment = [&](const char* attribute) { return checked_number(inertial, "inertia", attribute); };
  const double xx = moment("ixx"), yy = moment("iyy"), zz = moment("izz");
  const double xy = moment("ixy"), xz = moment("ixz"), yz = moment("iyz");
  Matrix3 inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Pose frame = read_origin(inertial);
  const Matrix3 rotation = frame.orientation.toRotationMatrix();
  return RigidInertia{checked_number(inertial, "mass", "value"), frame.position,
                      rotation * inertia * rotation.transpose(), (rotary ? *rotary : inertial).location()};
}

/// Reads the inner radius of a tube; 0: a solid cylinder [m].
double read_bore(const XmlElement& collision, double radius) {
  const std::optional<XmlElement> geometry = collision.child("geometry");
  const std::optional<XmlElement> cylinder = geometry ? geometry->child("cylinder") : std::nullopt;
  if (!cylinder || !cylinder->has("inner_radius")) return 0;
  const double inner = cylinder->number("inner_radius", kNonNegative, 0);
  if (inner < radius) return inner;
  cylinder->attribute_error("inner_radius", fmt::format("inner_radius must be less than the radius, {:g}", radius));
  return 0;
}

}  // namespace

void judge_material(const XmlElement& material) {
  judge_alone(material, printed(material.xml()) + "<link name=\"link\"/>");
}

LinkDescription read_link(const XmlElement& unnamed) {
  LinkDescription description;
  description.name = unnamed.name("name").value_or("");
  description.location = unnamed.location();
  const XmlElement link = unnamed.with_name(description.name);
  link.expect_first_counts({"inertial"});
  link.expect_at_most_one({"beam", "drag"});
  if (const std::optional<XmlElement> inertial = link.child("inertial"))
    description.inertial = read_inertial(*inertial);
  // Give urdfdom one child at a time, since it stops reading a link at the first error.
  for (const XmlElement& child : link.children()) {
    if (child.tag() != "visual" && child.tag() != "collision") continue;
    const bool is_good = judge_alone(child, "<link name=\"link\">" + printed(child.xml()) + "</link>");
    const bool is_collision = child.tag() == "collision";
    if (!is_good) continue;
    if (std::optional<VisualDescription> shape = shape_of_urdfdom(child.xml())) {
      if (auto* cylinder = std::get_if<CylinderShape>(&shape->shape); cylinder && is_collision)
        cylinder->inner_radius = read_bore(child, cylinder->radius);
      (is_collision ? description.collisions : description.visuals).push_back(*shape);
    } else if (!is_collision && link.child("beam"))  // rviz draws those of rigid links itself
      child.warning("is not shown: its shape must have an extent, of finite numbers");
  }
  return description;
}

void warn_of_untouchable_shapes(const XmlElement& robot) {
  for (const XmlElement& unnamed : robot.children()) {
    if (unnamed.tag() != "link") continue;
    const XmlElement link = unnamed.with_name(unnamed.has("name") ? *unnamed.text("name") : "");
    for (const XmlElement& child : link.children()) {
      if (child.tag() != "collision" || shape_of_urdfdom(child.xml())) continue;
      const std::optional<XmlElement> geometry = child.child("geometry");
      const tinyxml2::XMLElement* shape = geometry ? geometry->xml().FirstChildElement() : nullptr;
      child.warning("touches nothing: its shape must be a box, cylinder or mesh that has an extent, or a sphere",
                    shape ? quoted(printed(*shape)) : "");
    }
  }
}

}  // namespace flexarm::scene
