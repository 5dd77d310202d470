#include "scene/point_spring_reader.h"

#include "elements/point_spring.h"
#include "flexarm/scene/point_spring.h"
#include "scene/force_element_kinds.h"

namespace flexarm::scene {

std::vector<double> PointSpring::numbers() const {
  std::vector<double> numbers = {stiffness, rest_length ? 1.0 : 0.0};
  if (rest_length) numbers.push_back(*rest_length);
  numbers.push_back(damping);
  return numbers;
}

std::shared_ptr<ForceElementDescription> PointSpring::with_links(const LinkChanges& change) const {
  auto out = std::make_shared<PointSpring>(*this);
  out->change_links(change);
  return out;
}

std::shared_ptr<const ForceElement> PointSpring::place(const ForcePlacement& placement) const {
  const std::vector<NodePoint>& places = placement.places;
  const std::vector<Vector3>& positions = placement.positions;
  const double length = (positions[1] - positions[0]).norm();
  return std::make_shared<flexarm::PointSpring>(
      name, places[0], places[1], flexarm::PointSpring::Law{stiffness, rest_length.value_or(length), damping});
}

std::shared_ptr<const ForceElementDescription> read_point_spring(const XmlElement& spring) {
  spring.expect_only({"name", "from", "from_at", "to", "to_at", "stiffness", "rest_length", "damping"});
  auto out = std::make_shared<PointSpring>();
  read_ends(spring, *out);
  out->stiffness = spring.number("stiffness", kNonNegative).value_or(0);
  if (spring.has("rest_length")) out->rest_length = spring.number("rest_length", kNonNegative);
  out->damping = spring.number("damping", kNonNegative, 0);
  return out;
}

}  // namespace flexarm::scene
