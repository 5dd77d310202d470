#include <algorithm>
#include <string>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "scene/scene_checks.h"

namespace flexarm::scene {
namespace {

/// Largest width of a section. [m]
double width_of(const SectionShape& shape) {
  return std::visit(
      [](const auto& s) {
        using Shape = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<Shape, Circle>)
          return 2 * s.radius;
        else if constexpr (std::is_same_v<Shape, Tube>)
          return 2 * s.outer_radius;
        else
          return std::max(s.width, s.height);
      },
      shape);
}

/// Sum of the distances between the ends of the pieces: the length, but for arcs. [m]
double length_of(const BeamDescription& beam) {
  double length = 0;
  Vector3 from = Vector3::Zero();
  for (const CentrelinePiece& piece : beam.centreline) {
    length += (piece.to - from).norm();
    from = piece.to;
  }
  return length;
}

/// The section, or the one at the first station; null if it is not given by its geometry.
const GeometricSection* first_section(const BeamDescription& beam) {
  if (const auto* stations = std::get_if<SectionStations>(&beam.section))
    return std::get_if<GeometricSection>(&stations->sections.front());
  return std::get_if<GeometricSection>(&beam.section);
}

/// Stiffer than a gel; metals are denser than kHeavy and stiffer than kSoft. [Pa, kg/m^3]
constexpr double kGel = 1e4, kSoft = 1e6, kHeavy = 2000;
/// A foam is denser; water is 1 g/cm^3. [kg/m^3]
constexpr double kFoam = 25, kLightest = 0.5;
/// A longer beam that is this many times longer than wide is probably not given in metres. [m]
constexpr double kLong = 100, kSlender = 1e4;

}  // namespace

void warn_of_units(const SceneDescription& scene, Findings& findings) {
  for (const LinkDescription& link : scene.links) {
    const GeometricSection* section = link.beam ? first_section(*link.beam) : nullptr;
    if (!section) continue;
    const auto warn = [&](const std::string& text) {
      findings.warning(link.beam->location.line, "<beam> of link " + quoted(link.name), text);
    };
    const double width = width_of(section->shape), length = length_of(*link.beam);
    const auto& [young, poisson, density] = section->material;
    if (young < kGel || (young < kSoft && density > kHeavy))
      warn(fmt::format("young = {} is in Pa, which makes it very soft: aluminium has 70e9, rubber 5e6", young));
    if (density > kLightest && density < kFoam)
      warn(fmt::format("density = {} is in kg/m^3, which makes it very light: aluminium has 2700, foam 30", density));
    if (width > length)
      warn(
          fmt::format("is {} m thick and {} m long: a beam is longer than thick, and lengths are in m", width, length));
    if (length > kLong && length > kSlender * width)
      warn(fmt::format("is {} m long and {} m thick: lengths are in m", length, width));
  }
}

}  // namespace flexarm::scene
