#include "scene/friction_reader.h"

#include "scene/choice.h"

namespace flexarm::scene {
namespace {

constexpr Choice<FrictionDescription::Law> kLaws[] = {{"smooth", FrictionDescription::Law::Smooth},
                                                      {"coulomb", FrictionDescription::Law::Coulomb}};

/// Whether a joint needs the radius at which the friction of its rotation acts.
enum class Radius { Needed, Optional, Useless };
Radius radius_of(const JointDescription& joint) {
  if (joint.kind == JointKind::Prismatic) return Radius::Useless;
  if (joint.kind != JointKind::Slide) return Radius::Needed;
  const JointKind rotation = joint.slide->rotation;
  return rotation == JointKind::Fixed || rotation == JointKind::Spherical ? Radius::Useless : Radius::Optional;
}

bool has_normal_force(JointKind kind) {
  return kind != JointKind::Fixed && kind != JointKind::Floating && kind != JointKind::Spherical &&
         kind != JointKind::Planar;
}

void check_radius(const XmlElement& friction, double coefficient, Radius radius) {
  const bool has_radius = friction.has("radius");
  if (has_radius && radius == Radius::Useless)
    friction.attribute_error("radius", "nothing turns about an axis here; leave this out");
  else if (has_radius && !friction.has("coefficient"))
    friction.attribute_error("radius", "it acts with a coefficient only; leave this out");
  else if (coefficient > 0 && radius == Radius::Needed && !has_radius)
    friction.error("a coefficient on a rotation needs the radius of the bearing, radius > 0");
}

}  // namespace

void read_friction(const XmlElement& friction, JointDescription& description) {
  friction.expect_only({"law", "coefficient", "radius"});
  FrictionDescription out;
  out.law = read_choice(friction, "law", kLaws, out.law);
  out.coefficient = friction.number("coefficient", kNonNegative, 0);
  out.radius = friction.has("radius") ? friction.number("radius", kPositive).value_or(0) : 0;
  if (friction.has("coefficient") && !has_normal_force(description.kind))
    friction.attribute_error("coefficient",
                             "fixed, floating, spherical and planar joints have no force that presses; leave this out, "
                             "and give a constant effort, <dynamics friction>");
  else
    check_radius(friction, out.coefficient, radius_of(description));
  description.friction_law = out;
}

}  // namespace flexarm::scene
