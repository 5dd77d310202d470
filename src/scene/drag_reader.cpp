#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/readers.h"

namespace flexarm::scene {
namespace {

constexpr std::size_t kMostNumbers = 3;

/// Reads a number >= 0 for each of the axes of flow, or one for all of them. A beam has the axes y and z of its
/// section, a rigid link has all three.
std::optional<Vector3> read_per_axis(const XmlElement& drag, const char* attribute, bool is_beam) {
  const std::optional<std::vector<double>> numbers = drag.all_numbers(attribute, kMostNumbers);
  if (!numbers) return std::nullopt;
  const std::size_t axes = is_beam ? 2 : 3;
  const bool is_good = std::all_of(numbers->begin(), numbers->end(), kNonNegative.holds);
  if (!is_good || (numbers->size() != 1 && numbers->size() != axes)) {
    drag.attribute_error(attribute,
                         fmt::format("{} must be one number >= 0, or {} of them: for flow along {}", attribute, axes,
                                     is_beam ? "y and z of the section" : "x, y and z of the link"));
    return std::nullopt;
  }
  Vector3 out = Vector3::Zero();
  for (std::size_t i = 0; i < axes; ++i) out[static_cast<int>(3 - axes + i)] = (*numbers)[numbers->size() == 1 ? 0 : i];
  return out;
}

/// Whether the shape of the section is known.
bool has_shape(const Section& section) {
  if (const auto* stations = std::get_if<SectionStations>(&section))
    return std::holds_alternative<GeometricSection>(stations->sections.front());
  return std::holds_alternative<GeometricSection>(section);
}

}  // namespace

std::optional<DragDescription> read_drag(const XmlElement& drag, const LinkDescription& link) {
  const std::size_t errors = drag.findings().error_count();
  const bool is_beam = link.beam.has_value();
  if (is_beam)
    drag.expect_only({"coefficient", "density", "width"});
  else
    drag.expect_only({"coefficient", "density", "area", "at"});
  DragDescription out;
  out.location = drag.location();
  out.coefficient = read_per_axis(drag, "coefficient", is_beam).value_or(Vector3::Zero());
  out.density = drag.number("density", kNonNegative, out.density);
  const char* size = is_beam ? "width" : "area";
  if (drag.has(size) || !is_beam) out.area = read_per_axis(drag, size, is_beam);
  if (drag.has("at")) out.at = drag.vector("at");
  if (is_beam && !out.area && !has_shape(link.beam->section) && drag.findings().error_count() == errors)
    drag.error("attribute 'width' is missing, and the <beam> has no shape from which it would follow");
  if (drag.findings().error_count() > errors) return std::nullopt;
  return out;
}

}  // namespace flexarm::scene
