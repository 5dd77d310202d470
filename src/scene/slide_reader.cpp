#include "scene/slide_reader.h"

#include <algorithm>

namespace flexarm::scene {

void read_slide(const XmlElement& slide, JointDescription& description) {
  slide.expect_only({"start", "rotation", "on_end", "scheme"});
  SlideDescription out;
  out.location = slide.location();
  out.start = slide.number("start", kNonNegative).value_or(0);
  const std::string rotation = slide.has("rotation") ? slide.text("rotation").value_or("") : "spherical";
  if (rotation == "fixed")
    out.rotation = JointKind::Fixed;
  else if (rotation == "revolute")
    out.rotation = JointKind::Revolute;
  else if (rotation == "universal")
    out.rotation = JointKind::Universal;
  else if (rotation == "screw")
    slide.attribute_error("rotation", "a screw on a slide is not yet supported in this version");
  else if (rotation != "spherical")
    slide.attribute_error("rotation", "rotation must be one of spherical, fixed, revolute, universal");
  const std::string on_end = slide.has("on_end") ? slide.text("on_end").value_or("") : "stop";
  if (on_end == "error")
    out.on_end = SlideDescription::End::Error;
  else if (on_end == "free")
    slide.attribute_error("on_end", "leaving the line is not yet supported in this version; 'stop' and 'error' are");
  else if (on_end != "stop")
    slide.attribute_error("on_end", "on_end must be 'stop' or 'error'");
  if (slide.has("scheme")) {
    const std::string scheme = slide.text("scheme").value_or("");
    constexpr const char* kPlanned[] = {"alg1", "alg2", "alg3", "alg4", "sme"};
    if (std::find(std::begin(kPlanned), std::end(kPlanned), scheme) != std::end(kPlanned))
      slide.attribute_error("scheme", "this scheme is not yet supported in this version; 'sm_em' is");
    else if (scheme != "sm_em")
      slide.attribute_error("scheme", "scheme must be 'sm_em'");
  }
  description.kind = JointKind::Slide;
  description.slide = out;
}

}  // namespace flexarm::scene
