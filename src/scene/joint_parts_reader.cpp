#include <stdexcept>

#include "scene/joint_kinds.h"
#include "scene/limits.h"
#include "scene/readers.h"
#include "schemes/slide_scheme.h"

namespace flexarm::scene {

// ---------------------------------------------------------------- <couple>

namespace {

/// Reads the direction of the travel of a rack or cam, which must be normal to the axis of rotation. On a slide, the
/// travel is along the line, and a direction is an error.
void read_normal_direction(const XmlElement& couple, JointDescription& description) {
  if (description.slide) {
    if (couple.has("direction")) couple.attribute_error("direction", "on a slide the travel is along the line");
    return;
  }
  const std::optional<Vector3> direction = couple.direction("direction");
  if (!direction) return;
  description.direction = *direction;
  if (std::abs(direction->dot(description.axis)) > 1e-6)
    couple.attribute_error("direction", "the direction must be normal to the joint's axis");
}

std::shared_ptr<const CamProfile> read_table(const XmlElement& profile) {
  const std::optional<std::vector<double>> angles = profile.all_numbers("theta", kMostProfilePoints);
  const std::optional<std::vector<double>> travels = profile.all_numbers("r", kMostProfilePoints);
  if (!angles || !travels) return nullptr;
  try {
    return std::make_shared<CamProfile>(CamProfile::periodic(*angles, *travels));
  } catch (const std::invalid_argument& error) {
    profile.error(error.what());
    return nullptr;
  }
}

std::shared_ptr<const CamProfile> read_profile(const XmlElement& couple) {
  const std::optional<XmlElement> profile = couple.child("profile");
  if (!profile) {
    couple.error("a cam needs <profile kind=\"eccentric\" .../> or <profile kind=\"table\" .../>");
    return nullptr;
  }
  const std::string kind = profile->text("kind").value_or("");
  if (kind == "eccentric") {
    profile->expect_only({"kind", "radius", "offset"});
    const std::optional<double> radius = profile->number("radius", kPositive);
    const double offset = profile->number("offset", kAnyNumber, 0);
    return radius ? std::make_shared<CamProfile>(CamProfile::eccentric(*radius, offset)) : nullptr;
  }
  if (kind == "table") {
    profile->expect_only({"kind", "theta", "r"});
    return read_table(*profile);
  }
  profile->attribute_error("kind", "kind must be 'eccentric' or 'table'");
  return nullptr;
}

void read_worm(const XmlElement& joint, const XmlElement& couple, JointDescription& description) {
  couple.expect_only({"kind", "ratio", "offset"});
  description.kind = JointKind::Worm;
  description.ratio = couple.number("ratio", kNotZero).value_or(0);
  description.offset = couple.number("offset", kAnyNumber, 0);
  if (description.slide) return;
  const std::optional<XmlElement> axis2 = joint.child("axis2");
  if (!axis2) {
    joint.error("a worm needs the direction of its travel, <axis2 xyz=\"...\"/>");
    return;
  }
  axis2->expect_only({"xyz"});
  description.direction = axis2->direction("xyz").value_or(description.direction);
}

}  // namespace

void read_couple(const XmlElement& joint, const XmlElement& couple, JointDescription& description) {
  const std::string kind = couple.text("kind").value_or("");
  couple.expect_at_most_one({"profile"});
  if (kind == "screw") {
    couple.expect_only({"kind", "pitch"});
    description.kind = JointKind::Screw;
    description.ratio = couple.number("pitch", kNotZero).value_or(0);
  } else if (kind == "rack_and_pinion") {
    couple.expect_only({"kind", "radius", "direction"});
    description.kind = JointKind::RackAndPinion;
    description.ratio = couple.number("radius", kPositive).value_or(0);
    read_normal_direction(couple, description);
  } else if (kind == "worm") {
    read_worm(joint, couple, description);
  } else if (kind == "cam") {
    couple.expect_only({"kind", "direction"}, {"profile"});
    description.kind = JointKind::Cam;
    read_normal_direction(couple, description);
    description.profile = read_profile(couple);
  } else {
    couple.attribute_error("kind", "kind must be one of screw, rack_and_pinion, worm, cam");
  }
}

// ---------------------------------------------------------------- <slide>

namespace {

constexpr Choice<JointKind> kRotations[] = {{"spherical", JointKind::Spherical},
                                            {"fixed", JointKind::Fixed},
                                            {"revolute", JointKind::Revolute},
                                            {"universal", JointKind::Universal},
                                            {"screw", JointKind::Screw}};
constexpr Choice<SlideDescription::End> kEnds[] = {{"stop", SlideDescription::End::Stop},
                                                   {"error", SlideDescription::End::Error},
                                                   {"free", SlideDescription::End::Free}};
constexpr Choice<bool> kLines[] = {{"elements", false}, {"smooth", true}};

/// Reads how the slider rotates relative to the beam's section: by one of the kinds of rotation, or by a <couple>,
/// whose travel is the one along the line.
JointKind read_rotation(const XmlElement& joint, const XmlElement& slide, JointDescription& description) {
  const JointKind rotation = read_choice(slide, "rotation", kRotations, JointKind::Spherical);
  if (const std::optional<XmlElement> couple = slide.child("couple")) {
    if (slide.has("rotation")) slide.attribute_error("rotation", "<couple> says how it turns; leave this out");
    read_couple(joint, *couple, description);
    return description.kind;
  }
  if (rotation == JointKind::Screw)
    description.ratio = slide.number("pitch", kNotZero).value_or(0);
  else if (slide.has("pitch"))
    slide.attribute_error("pitch", "only rotation=\"screw\" has a pitch; leave this out");
  return rotation;
}

}  // namespace

void read_slide(const XmlElement& joint, const XmlElement& slide, JointDescription& description) {
  slide.expect_only({"start", "rotation", "pitch", "on_end", "scheme", "line", "offset", "restitution"}, {"couple"});
  SlideDescription out;
  out.location = slide.location();
  out.start = slide.number("start", kNonNegative).value_or(0);
  description.slide = out;
  out.rotation = read_rotation(joint, slide, description);
  out.on_end = read_choice(slide, "on_end", kEnds, out.on_end);
  if (slide.has("scheme"))
    if (const SlideScheme* scheme = read_row(slide, "scheme", kSlideSchemes)) out.scheme = scheme->name;
  out.smooth = read_choice(slide, "line", kLines, out.smooth);
  out.offset = slide.vector("offset", out.offset);
  if (slide.has("restitution")) out.restitution = slide.number("restitution", kRestitution);
  if (out.restitution && out.on_end != SlideDescription::End::Stop)
    slide.attribute_error("restitution", "only ends that stop have one; leave this out");
  description.kind = JointKind::Slide;
  description.slide = out;
}

// ---------------------------------------------------------------- <friction>

namespace {

constexpr Choice<FrictionDescription::Law> kLaws[] = {{"smooth", FrictionDescription::Law::Smooth},
                                                      {"coulomb", FrictionDescription::Law::Coulomb}};

constexpr NumberRange kAtLeastOne{">= 1", [](double x) { return x >= 1; }};

/// Whether a joint needs the radius at which the friction of its rotation acts.
enum class Radius { Needed, Optional, Useless };
Radius radius_of(const JointDescription& joint) {
  if (joint.kind == JointKind::Prismatic) return Radius::Useless;
  if (joint.kind != JointKind::Slide) return Radius::Needed;
  const JointKind rotation = joint.slide->rotation;
  return rotation == JointKind::Fixed || rotation == JointKind::Spherical ? Radius::Useless : Radius::Optional;
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
  friction.expect_only({"law", "coefficient", "radius", "static", "stribeck"});
  FrictionDescription out;
  out.law = read_choice(friction, "law", kLaws, out.law);
  out.coefficient = friction.number("coefficient", kNonNegative, 0);
  out.radius = friction.has("radius") ? friction.number("radius", kPositive).value_or(0) : 0;
  out.static_ratio = friction.number("static", kAtLeastOne, out.static_ratio);
  out.stribeck_speed = friction.number("stribeck", kPositive, out.stribeck_speed);
  if (friction.has("stribeck") && !friction.has("static"))
    friction.attribute_error("stribeck", "friction falls with the speed only if there is more at rest, static > 1");
  if (friction.has("coefficient") && !traits_of(description.kind).has_normal_force)
    friction.attribute_error(
        "coefficient",
        "fixed, floating, spherical and planar joints have no normal force on which friction could depend; leave "
        "this out, and give a constant friction effort, <dynamics friction>");
  else
    check_radius(friction, out.coefficient, radius_of(description));
  description.friction_law = out;
}

}  // namespace flexarm::scene
