#include "scene/couple_reader.h"

#include <stdexcept>

#include "scene/limits.h"

namespace flexarm::scene {
namespace {

/// A travel of a rack or cam has no part along the axis, about which the joint turns. On a slide it is along the line.
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

}  // namespace flexarm::scene
