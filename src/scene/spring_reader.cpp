#include "scene/spring_reader.h"

namespace flexarm::scene {

PointSpring read_point_spring(const XmlElement& spring) {
  spring.expect_only({"from", "from_at", "to", "to_at", "stiffness", "rest_length", "damping"});
  PointSpring out;
  out.location = spring.location();
  out.from = spring.name("from").value_or("");
  out.from_at = spring.vector("from_at", out.from_at);
  out.to = spring.name("to").value_or("");
  out.to_at = spring.vector("to_at", out.to_at);
  out.stiffness = spring.number("stiffness", kNonNegative).value_or(0);
  if (spring.has("rest_length")) out.rest_length = spring.number("rest_length", kNonNegative);
  out.damping = spring.number("damping", kNonNegative, 0);
  return out;
}

}  // namespace flexarm::scene
