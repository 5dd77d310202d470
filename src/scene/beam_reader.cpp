#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "math/pi.h"
#include "scene/limits.h"
#include "scene/readers.h"
#include "scene/section_reader.h"

namespace flexarm::scene {
namespace {

constexpr double kArcTolerance = 1e-6;       // relative difference of an arc's radii
constexpr double kParallelTolerance = 1e-6;  // sine of an angle

/// State of the reader at the end of the last piece of the centreline. Tangents are unit vectors.
struct Progress {
  Vector3 position = Vector3::Zero();
  std::optional<Vector3> first_tangent, tangent;  // empty before the first piece
  bool is_known = true;                           // false after a bad piece: the next one has no start
};

struct Tangents {
  Vector3 begin, end;
};

bool has_length(const XmlElement& piece, const Vector3& from, const Vector3& to) {
  const double length = (to - from).norm();
  if (length > 0 && length < kLongestPiece) return true;
  piece.attribute_error(
      "to", fmt::format("the {} must have a length between 0 and {} m, now {}", piece.tag(), kLongestPiece, length));
  return false;
}

std::optional<Tangents> line_tangents(const XmlElement& line, const Vector3& from, const Vector3& to) {
  if (!has_length(line, from, to)) return std::nullopt;
  const Vector3 tangent = (to - from).normalized();
  return Tangents{tangent, tangent};
}

std::optional<Tangents> arc_tangents(const XmlElement& arc, const Vector3& from, const Vector3& to,
                                     const Vector3& center) {
  if (!has_length(arc, from, to)) return std::nullopt;
  const Vector3 first = from - center, last = to - center;
  const double radius = 0.5 * (first.norm() + last.norm());
  if (!(radius < kLongestPiece)) {
    arc.attribute_error("center", fmt::format("the radius must be less than {} m", kLongestPiece));
  } else if (std::abs(first.norm() - last.norm()) > kArcTolerance * radius) {
    arc.attribute_error("center", fmt::format("center must be equally far from both ends (now {} and {} m)",
                                              first.norm(), last.norm()));
  } else if (first.cross(last).norm() <= kParallelTolerance * radius * radius) {
    // Both ends and the centre lie on one line: a half circle, whose plane is undetermined, or hardly any length.
    arc.attribute_error("center", "center must not lie on the line through both ends (give a half circle as two arcs)");
  } else {
    const Vector3 axis = first.cross(last).normalized();
    return Tangents{axis.cross(first).normalized(), axis.cross(last).normalized()};
  }
  return std::nullopt;
}

/// Reads a <line> or an <arc> and moves `progress` to its end. Returns nothing if there is an error.
std::optional<CentrelinePiece> read_piece(const XmlElement& element, Progress& progress) {
  const bool is_arc = element.tag() == "arc";
  is_arc ? element.expect_only({"to", "center", "twist"}) : element.expect_only({"to", "twist"});
  CentrelinePiece piece;
  piece.location = element.location();
  piece.kind = is_arc ? CentrelinePiece::Kind::Arc : CentrelinePiece::Kind::Line;
  piece.twist = element.number("twist", kAnyNumber, 0);
  const std::optional<Vector3> to = element.vector("to");
  const std::optional<Vector3> center = is_arc ? element.vector("center") : Vector3(Vector3::Zero());
  if (!to || !center || !progress.is_known) return std::nullopt;
  piece.to = *to;
  piece.center = *center;
  const std::optional<Tangents> tangents =
      is_arc ? arc_tangents(element, progress.position, *to, *center) : line_tangents(element, progress.position, *to);
  if (!tangents) return std::nullopt;
  if (progress.tangent && progress.tangent->dot(tangents->begin) < -1 + kArcTolerance) {
    element.attribute_error("to", "the centreline must not turn back on itself");
    return std::nullopt;
  }
  if (!progress.tangent) progress.first_tangent = tangents->begin;
  progress.tangent = tangents->end;
  progress.position = *to;
  return piece;
}

/// Sets `first_tangent` if the first piece has no errors.
std::vector<CentrelinePiece> read_centreline(const XmlElement& beam, std::optional<Vector3>& first_tangent) {
  const std::optional<XmlElement> centreline = beam.child("centerline");
  if (!centreline) {
    beam.error("<centerline> is missing");
    return {};
  }
  centreline->expect_only({}, {"line", "arc"});
  const std::vector<XmlElement> elements = centreline->children();
  if (elements.empty()) centreline->error("at least one <line> or <arc> is expected");
  if (elements.size() > kMostCentrelinePieces) {
    centreline->error(fmt::format("a centreline has at most {} pieces", kMostCentrelinePieces),
                      fmt::format("'{}'", elements.size()));
    return {};
  }
  std::vector<CentrelinePiece> pieces;
  Progress progress;
  for (const XmlElement& element : elements) {
    if (element.tag() != "line" && element.tag() != "arc") continue;
    const std::optional<CentrelinePiece> piece = read_piece(element, progress);
    progress.is_known = piece.has_value();
    if (piece) pieces.push_back(*piece);
  }
  first_tangent = progress.first_tangent;
  return pieces;
}

void read_orientation(const XmlElement& beam, const std::optional<Vector3>& tangent, BeamDescription& description) {
  const std::optional<XmlElement> orientation = beam.child("orientation");
  if (!orientation) return;
  orientation->expect_only({"y"});
  description.section_y = orientation->direction("y");
  if (description.section_y && tangent && description.section_y->cross(*tangent).norm() < kParallelTolerance)
    orientation->attribute_error("y", "y must not be parallel to the centreline's first tangent");
}

constexpr Choice<std::optional<bool>> kRefines[] = {{"auto", {}}, {"true", true}, {"false", false}};

void read_mesh(const XmlElement& beam, BeamDescription& description) {
  const char* elements = beam.xml().Attribute("elements");
  if (elements && std::string_view(elements) != "auto")
    description.elements = beam.integer("elements", 0, kMostBeamElements, " or 'auto'");
  if (beam.has("order")) description.order = beam.integer("order", 1, 4).value_or(description.order);
  description.refine = read_choice(beam, "refine", kRefines, {});
  if (!description.refine.value_or(false)) return;
  if (description.order != 2)
    beam.attribute_error("refine",
                         fmt::format("elements of order 2 can be halved, not those of order {}", description.order));
  if (description.elements == 0) beam.attribute_error("refine", "a rigid beam has no elements that could be halved");
}

constexpr Choice<HubDescription::End> kHubEnds[] = {{"start", HubDescription::End::Start},
                                                    {"end", HubDescription::End::End}};

void read_hubs(const XmlElement& beam, BeamDescription& description) {
  for (const XmlElement& element : beam.children()) {
    if (element.tag() != "hub") continue;
    element.expect_only({"at", "mass", "inertia"});
    HubDescription hub;
    hub.location = element.location();
    hub.end = read_choice(element, "at", kHubEnds).value_or(hub.end);
    hub.mass = element.number("mass", kNonNegative).value_or(0);
    hub.inertia = element.vector("inertia", Vector3::Zero());
    if (hub.inertia.minCoeff() < 0) element.attribute_error("inertia", "moments of inertia must be >= 0");
    for (const HubDescription& other : description.hubs)
      if (other.end == hub.end)
        element.attribute_error("at", fmt::format("this end has a hub already, by line {}", other.location.line));
    description.hubs.push_back(hub);
  }
}

constexpr std::array<const char*, 6> kStrains = {"axial", "shear_y", "shear_z", "torsion", "bending_y", "bending_z"};

/// Reads damping coefficients of single strains; a strain without an attribute is not damped. Returns false if no
/// strain has an attribute.
bool read_damping_of_strains(const XmlElement& damping, BeamDescription& description) {
  const auto has = [&](const char* strain) { return damping.has(strain); };
  if (std::none_of(kStrains.begin(), kStrains.end(), has)) return false;
  for (const char* attribute : {"stiffness_proportional", "ratio"})
    if (damping.has(attribute)) damping.attribute_error(attribute, "damping is given for strains one by one already");
  Vector6 coefficients;
  for (int i = 0; i < 6; ++i) coefficients[i] = damping.number(kStrains[i], kNonNegative, 0);
  double& largest = description.stiffness_proportional_damping = coefficients.maxCoeff();
  if (largest > 0) description.damping_shares = coefficients / largest;
  description.mass_proportional_damping = damping.number("mass_proportional", kNonNegative, 0);
  return true;
}

void read_maxwell(const XmlElement& damping, BeamDescription& description) {
  for (const XmlElement& element : damping.children()) {
    if (element.tag() != "maxwell") continue;
    element.expect_only({"modulus_ratio", "relaxation_time"});
    const std::optional<double> ratio = element.number("modulus_ratio", kPositive);
    const std::optional<double> time = element.number("relaxation_time", kPositive);
    if (ratio && time) description.maxwell.push_back({*ratio, *time});
  }
}

/// Reads the damping coefficients eta (stiffness-proportional) and alpha (mass-proportional), or computes them from the
/// damping ratio of modes, which is eta w / 2 + alpha / (2 w) at the circular frequency w.
void read_damping(const XmlElement& damping, BeamDescription& description) {
  damping.expect_only({"stiffness_proportional", "mass_proportional", "ratio", "frequency", "frequencies", "axial",
                       "shear_y", "shear_z", "torsion", "bending_y", "bending_z"},
                      {"maxwell"});
  read_maxwell(damping, description);
  if (read_damping_of_strains(damping, description)) return;
  double &eta = description.stiffness_proportional_damping, &alpha = description.mass_proportional_damping;
  if (!damping.has("ratio")) {
    for (const char* attribute : {"frequency", "frequencies"})
      if (damping.has(attribute)) damping.error(std::string(attribute) + " needs the damping ratio there, ratio");
    eta = damping.number("stiffness_proportional", kNonNegative, 0);
    alpha = damping.number("mass_proportional", kNonNegative, 0);
    return;
  }
  for (const char* attribute : {"stiffness_proportional", "mass_proportional"})
    if (damping.has(attribute)) damping.attribute_error(attribute, "damping is given by ratio already");
  const std::optional<double> ratio = damping.number("ratio", kNonNegative);
  if (damping.has("frequency") == damping.has("frequencies")) {
    damping.error("either frequency, where the modes have that damping ratio, or two frequencies are expected");
  } else if (damping.has("frequency")) {
    const std::optional<double> frequency = damping.number("frequency", kPositive);
    if (ratio && frequency) eta = *ratio / (kPi * *frequency);
  } else {
    const std::optional<std::vector<double>> f = damping.numbers("frequencies", 2, kPositive);
    if (!ratio || !f) return;
    const double sum = (*f)[0] + (*f)[1];
    eta = *ratio / (kPi * sum);
    alpha = 4 * kPi * *ratio * (*f)[0] * (*f)[1] / sum;
  }
}

void read_prestrain(const XmlElement& prestrain, BeamDescription& description) {
  prestrain.expect_only({"axial", "shear_y", "shear_z", "torsion", "bending_y", "bending_z"});
  const auto has = [&](const char* strain) { return prestrain.has(strain); };
  if (std::none_of(kStrains.begin(), kStrains.end(), has))
    prestrain.error("at least one strain is expected: axial, shear_y, shear_z, torsion, bending_y or bending_z");
  for (std::size_t i = 0; i < kStrains.size(); ++i)
    if (prestrain.has(kStrains[i])) description.prestrain[i] = prestrain.function(kStrains[i]);
}

}  // namespace

std::optional<BeamDescription> read_beam(const XmlElement& unowned, const std::string& link) {
  const XmlElement beam = unowned.with_owner("beam " + quoted(link));
  const std::size_t errors = beam.findings().error_count();
  beam.expect_only({"elements", "order", "refine"},
                   {"centerline", "orientation", "circle", "tube", "rectangle", "box_tube", "material", "section",
                    "section_matrix", "stations", "damping", "prestrain", "hub"});
  beam.expect_at_most_one({"centerline", "orientation", "material", "stations", "damping", "prestrain"});
  BeamDescription description;
  description.location = beam.location();
  read_mesh(beam, description);
  std::optional<Vector3> first_tangent;
  description.centreline = read_centreline(beam, first_tangent);
  read_orientation(beam, first_tangent, description);
  if (const std::optional<Section> section = read_section(beam)) description.section = *section;
  if (const std::optional<XmlElement> damping = beam.child("damping")) read_damping(*damping, description);
  if (const std::optional<XmlElement> prestrain = beam.child("prestrain")) {
    read_prestrain(*prestrain, description);
    // The springs of Maxwell elements would have to relax from the prestrain, too.
    if (!description.maxwell.empty()) prestrain->error("a beam with <maxwell> elements has no prestrain");
  }
  read_hubs(beam, description);
  if (beam.findings().error_count() > errors) return std::nullopt;
  return description;
}

}  // namespace flexarm::scene
