#include "scene/slide_reader.h"

#include "scene/choice.h"
#include "scene/couple_reader.h"
#include "schemes/slide_scheme.h"

namespace flexarm::scene {
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

/// What turns on the section: one of the rotations, or a joint whose travel is that along the line.
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

}  // namespace flexarm::scene
