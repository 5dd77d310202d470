#include "scene/friction_reader.h"

#include "scene/choice.h"

namespace flexarm::scene {
namespace {

constexpr Choice<FrictionDescription::Law> kLaws[] = {{"smooth", FrictionDescription::Law::Smooth},
                                                      {"coulomb", FrictionDescription::Law::Coulomb}};

/// Where the radius at which the friction of a rotation acts belongs.
enum class Radius { Needed, Optional, None };
Radius radius_of(JointKind kind) {
  switch (kind) {
    case JointKind::Prismatic:
      return Radius::None;
    case JointKind::Slide:
      return Radius::Optional;
    default:
      return Radius::Needed;
  }
}

bool has_normal_force(JointKind kind) {
  return kind != JointKind::Fixed && kind != JointKind::Floating && kind != JointKind::Spherical &&
         kind != JointKind::Planar;
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
  const Radius radius = radius_of(description.kind);
  if (friction.has("radius") && (radius == Radius::None || !friction.has("coefficient")))
    friction.attribute_error("radius", radius == Radius::None ? "a prismatic joint does not turn; leave this out"
                                                              : "it acts with a coefficient only; leave this out");
  if (out.coefficient > 0 && radius == Radius::Needed && !friction.has("radius"))
    friction.error("a coefficient on a rotation needs the radius of the bearing, radius > 0");
  description.friction_law = out;
}

}  // namespace flexarm::scene
