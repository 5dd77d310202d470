#include "scene/joint_kinds.h"
#include "scene/readers.h"

namespace flexarm::scene {
namespace {

/// Records errors for children of <joint> that act on its coordinate (mimic, friction, damping, stops). A joint with
/// play has no such coordinate: its child moves with the six degrees of freedom of a free body.
void refuse_what_needs_a_coordinate(const XmlElement& joint) {
  for (const char* tag : {"mimic", "friction"})
    if (const std::optional<XmlElement> child = joint.child(tag))
      child->error("a joint with <clearance> has none: leave this out" +
                   std::string(child->tag() == "friction" ? ", and give friction to <clearance>" : ""));
  if (const std::optional<XmlElement> dynamics = joint.child("dynamics"))
    for (const char* attribute : {"damping", "friction"})
      if (dynamics->number(attribute, kAnyNumber, 0) != 0)
        dynamics->attribute_error(attribute, "a joint with <clearance> has none; leave this out");
  if (const std::optional<XmlElement> limit = joint.child("limit"))
    for (const char* attribute : {"lower", "upper"})
      if (limit->number(attribute, kAnyNumber, 0) != 0)
        limit->attribute_error(attribute, "a joint with <clearance> has no stops; leave this out");
}

}  // namespace

ClearanceDescription read_clearance(const XmlElement& clearance, const XmlElement& joint,
                                    const JointDescription& description) {
  clearance.expect_only(
      {"radius", "length", "width", "journal", "contact_time", "stiffness", "restitution", "speeds", "friction"});
  ClearanceDescription out;
  out.location = clearance.location();
  out.joint = description;
  out.joint.limits.reset();
  out.radius = clearance.number("radius", kPositive).value_or(0);
  read_hardness(clearance, out.contact_time, out.stiffness);
  out.restitution = read_restitution(clearance);
  out.friction = clearance.number("friction", kNonNegative, 0);
  for (auto [attribute, value] : {std::pair("length", &out.length), std::pair("width", &out.width)})
    if (clearance.has(attribute)) *value = clearance.number(attribute, kPositive);
  if (clearance.has("journal")) out.journal = clearance.number("journal", kPositive).value_or(0);

  const JointKind kind = description.kind;
  if (!traits_of(kind).may_have_play) {
    clearance.error("only revolute, continuous, prismatic and spherical joints may have play");
    return out;
  }
  if (kind == JointKind::Spherical && clearance.has("length"))
    clearance.attribute_error("length", "a ball has none; leave this out");
  if (kind != JointKind::Prismatic && clearance.has("width"))
    clearance.attribute_error("width", "only the block of a prismatic joint has one; leave this out");
  if (kind == JointKind::Prismatic && clearance.has("journal"))
    clearance.attribute_error("journal",
                              "only the pin of a revolute joint and the ball of a spherical one have one; "
                              "leave this out");
  if (kind != JointKind::Prismatic && out.friction > 0 && !clearance.has("journal"))
    clearance.error("friction needs the radius of the pin or ball on which it acts, journal > 0");
  refuse_what_needs_a_coordinate(joint);
  return out;
}

void free_play(JointDescription& joint) {
  joint.kind = JointKind::Floating;
  joint.limits.reset();
  joint.mimic.reset();
  joint.damping = joint.friction = joint.effort_limit = 0;
  joint.friction_law = {};
}

}  // namespace flexarm::scene
