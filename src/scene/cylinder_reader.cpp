#include <algorithm>
#include <map>

#include "scene/readers.h"
#include "scene/standard_reader.h"

namespace flexarm::scene {
namespace {

/// Names of a cylinder's parts.
struct PartNames {
  std::string barrel, rod, hinge, pin;
  explicit PartNames(const std::string& name)
      : barrel(name + "_barrel"), rod(name + "_rod"), hinge(name + "_hinge"), pin(name + "_pin") {}
};

CylinderDescription::Part read_part(const XmlElement& cylinder, const char* tag) {
  CylinderDescription::Part part;
  const std::optional<XmlElement> element = cylinder.child(tag);
  if (!element) return part;
  element->expect_only({"mass", "length", "radius"});
  part.mass = element->number("mass", kNonNegative, 0);
  if (element->has("length")) part.length = element->number("length", kPositive);
  if (element->has("radius")) part.radius = element->number("radius", kPositive);
  if (part.mass > 0 && !element->has("length"))
    element->error("a part with a mass needs its length, for its inertia: length > 0");
  return part;
}

/// Inertia of a solid cylinder that begins at the link's origin and extends along x, or along -x if `side` is -1.
std::optional<RigidInertia> inertia_of(const CylinderDescription::Part& part, double side,
                                       const SourceLocation& location) {
  if (part.mass == 0) return std::nullopt;
  const double length = part.length.value_or(0), radius = part.radius.value_or(0);
  const double along = 0.5 * part.mass * radius * radius, across = 0.5 * along + part.mass * length * length / 12;
  return RigidInertia{part.mass, side * 0.5 * length * Vector3::UnitX(), Vector3(along, across, across).asDiagonal(),
                      location};
}

JointDescription joint_between(const std::string& name, JointKind kind, const std::string& parent,
                               const std::string& child, const SourceLocation& location) {
  JointDescription joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.location = location;
  joint.is_hidden = true;
  return joint;
}

/// Adds the parts of a cylinder, as if it lay along the x axis of `from`.
void add_parts(const ReadCylinder& read, SceneDescription& scene) {
  const CylinderDescription& cylinder = read.cylinder;
  const SourceLocation& location = cylinder.location;
  const PartNames names(cylinder.name);
  scene.links.push_back({names.barrel, inertia_of(cylinder.barrel, 1, location), {}, {}, {}, location});
  scene.links.push_back({names.rod, inertia_of(cylinder.rod, -1, location), {}, {}, {}, location});
  JointDescription hinge = joint_between(names.hinge, JointKind::Universal, cylinder.from, names.barrel, location);
  hinge.origin.position = cylinder.from_at;
  hinge.axis = Vector3::UnitZ();
  hinge.axis2 = Vector3::UnitY();
  JointDescription travel = read.travel;
  travel.parent = names.barrel;
  travel.child = names.rod;
  JointDescription pin = joint_between(names.pin, JointKind::Spherical, names.rod, cylinder.to, location);
  pin.child_origin.position = cylinder.to_at;
  scene.joints.push_back(hinge);
  scene.joints.push_back(travel);
  scene.loop_joints.push_back(pin);
  scene.cylinders.push_back(cylinder);
  if (!read.hydraulics) return;
  auto oil = std::make_shared<HydraulicsDescription>(*read.hydraulics->oil);
  oil->barrel = names.barrel;
  oil->rod = names.rod;
  scene.force_elements.push_back(std::move(oil));
}

/// Lines of names that are taken.
using Lines = std::map<std::string, int>;

template <class Named>
void note(const std::vector<Named>& things, Lines& lines) {
  for (const Named& thing : things) lines.emplace(thing.name, thing.location.line);
}

}  // namespace

ReadCylinder read_cylinder(const XmlElement& unnamed) {
  ReadCylinder out;
  CylinderDescription& cylinder = out.cylinder;
  cylinder.name = unnamed.name("name").value_or("");
  cylinder.location = unnamed.location();
  const XmlElement element = unnamed.with_name(cylinder.name);
  element.expect_only({"name", "from", "from_at", "to", "to_at"},
                      {"limit", "dynamics", "friction", "barrel", "rod", "spring", "drive", "servo", "hydraulics"});
  element.expect_at_most_one({"barrel", "rod", "spring", "drive", "servo", "hydraulics"});
  cylinder.from = element.name("from").value_or("");
  cylinder.to = element.name("to").value_or("");
  cylinder.from_at = element.vector("from_at", cylinder.from_at);
  cylinder.to_at = element.vector("to_at", cylinder.to_at);
  cylinder.barrel = read_part(element, "barrel");
  cylinder.rod = read_part(element, "rod");
  out.travel = joint_between(cylinder.name, JointKind::Prismatic, "", "", cylinder.location);
  out.travel.is_hidden = false;
  read_travel(element, out.travel, kNonNegative);
  if (const std::optional<XmlElement> hydraulics = element.child("hydraulics")) {
    out.hydraulics = read_hydraulics(*hydraulics, out.travel);
    if (out.hydraulics->pump) cylinder.pump = out.hydraulics->pump->name;
  }
  return out;
}

void add_cylinders(const std::vector<ReadCylinder>& cylinders, SceneDescription& scene,
                   std::set<std::string>& unreadable, Findings& findings) {
  Lines links, joints;
  note(scene.links, links);
  note(scene.joints, joints);
  note(scene.loop_joints, joints);
  const Lines ends = links;  // no barrels or rods, whose places are not known
  for (const ReadCylinder& read : cylinders) {
    const CylinderDescription& cylinder = read.cylinder;
    const std::size_t errors = findings.error_count();
    const auto error = [&](const std::string& expected, const std::string& got) {
      findings.error(cylinder.location.line, "<cylinder> " + quoted(cylinder.name), expected, quoted(got));
    };
    for (const auto& [end, link] : {std::pair("from", cylinder.from), std::pair("to", cylinder.to)})
      if (!link.empty() && ends.count(link) == 0)
        error(std::string(end) + " must be a link of the scene, and no part of a cylinder", link);
    if (!cylinder.from.empty() && cylinder.from == cylinder.to)
      error("from and to must be different links", cylinder.to);
    const PartNames names(cylinder.name);
    const auto take = [&](Lines& taken, const std::string& name, const std::string& what) {
      const auto [first, is_new] = taken.emplace(name, cylinder.location.line);
      if (!is_new) error("the name of " + what + " is taken, by line " + std::to_string(first->second), name);
    };
    if (!cylinder.name.empty()) {
      take(joints, cylinder.name, "its coordinate");
      if (findings.error_count() == errors) {
        take(links, names.barrel, "its barrel"), take(links, names.rod, "its rod");
        take(joints, names.hinge, "its hinge"), take(joints, names.pin, "its pin");
      }
    }
    const bool is_whole = !cylinder.name.empty() && !cylinder.from.empty() && !cylinder.to.empty();
    if (is_whole && findings.error_count() == errors)
      add_parts(read, scene);
    else
      unreadable.insert({cylinder.name, names.barrel, names.rod, names.hinge, names.pin, cylinder.pump});
  }
}

}  // namespace flexarm::scene
