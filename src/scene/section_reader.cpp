#include "scene/section_reader.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "scene/scene_checks.h"

namespace flexarm::scene {
namespace {

constexpr NumberRange kPoisson{"in (-1, 0.5)", [](double x) { return x > -1 && x < 0.5; }};

std::optional<SectionShape> read_tube(const XmlElement& tube) {
  tube.expect_only({"outer_radius", "inner_radius"});
  const std::optional<double> outer = tube.number("outer_radius", kPositive),
                              inner = tube.number("inner_radius", kPositive);
  if (!outer || !inner) return std::nullopt;
  if (*inner < *outer) return Tube{*outer, *inner};
  tube.attribute_error("inner_radius", fmt::format("inner_radius must be < outer_radius = {}", *outer));
  return std::nullopt;
}

std::optional<SectionShape> read_box_tube(const XmlElement& box) {
  box.expect_only({"width", "height", "thickness"});
  const std::optional<double> width = box.number("width", kPositive), height = box.number("height", kPositive),
                              thickness = box.number("thickness", kPositive);
  if (!width || !height || !thickness) return std::nullopt;
  if (2 * *thickness < std::min(*width, *height)) return BoxTube{*width, *height, *thickness};
  box.attribute_error("thickness", "thickness must be less than half of width and of height");
  return std::nullopt;
}

std::optional<SectionShape> read_shape(const XmlElement& shape) {
  if (shape.tag() == "tube") return read_tube(shape);
  if (shape.tag() == "box_tube") return read_box_tube(shape);
  if (shape.tag() == "circle") {
    shape.expect_only({"radius"});
    const std::optional<double> radius = shape.number("radius", kPositive);
    return radius ? std::optional<SectionShape>(Circle{*radius}) : std::nullopt;
  }
  shape.expect_only({"width", "height"});
  const std::optional<double> width = shape.number("width", kPositive), height = shape.number("height", kPositive);
  return width && height ? std::optional<SectionShape>(Rectangle{*width, *height}) : std::nullopt;
}

std::optional<Material> read_material(const XmlElement& material) {
  material.expect_only({"young", "poisson", "density"});
  const std::optional<double> young = material.number("young", kPositive),
                              poisson = material.number("poisson", kPoisson),
                              density = material.number("density", kPositive);
  if (!young || !poisson || !density) return std::nullopt;
  return Material{*young, *poisson, *density};
}

std::optional<DirectSection> read_direct_section(const XmlElement& section) {
  section.expect_only({"ea", "ga2", "ga3", "gj", "ei2", "ei3", "mass", "j1", "j2", "j3"});
  const auto read = [&](const char* name, const NumberRange& range) { return section.number(name, range).value_or(0); };
  const std::size_t errors = section.findings().error_count();
  DirectSection direct;
  direct.ea = read("ea", kPositive);
  direct.ga2 = read("ga2", kPositive);
  direct.ga3 = read("ga3", kPositive);
  direct.gj = read("gj", kPositive);
  direct.ei2 = read("ei2", kPositive);
  direct.ei3 = read("ei3", kPositive);
  direct.mass = read("mass", kPositive);
  direct.j1 = read("j1", kNonNegative);
  direct.j2 = read("j2", kNonNegative);
  direct.j3 = read("j3", kNonNegative);
  if (section.findings().error_count() > errors) return std::nullopt;
  return direct;
}

// ---------------------------------------------------------------- full matrices

constexpr double kMatrixTolerance = 1e-9;  // relative to the largest number of the matrix or block

/// Whether the matrix is symmetric up to round-off. Differences are compared with the diagonal, since translations and
/// rotations have different units.
bool is_symmetric(const Matrix6& matrix) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double scale = std::max(
          {std::abs(matrix(i, j)), std::abs(matrix(j, i)), std::sqrt(std::abs(matrix(i, i)) * std::abs(matrix(j, j)))});
      if (!(std::abs(matrix(i, j) - matrix(j, i)) <= kMatrixTolerance * scale)) return false;
    }
  }
  return true;
}

/// Scales rows and columns to a unit diagonal, so that a test of definiteness does not depend on units. Needs a
/// positive diagonal.
Matrix6 scaled_to_unit_diagonal(const Matrix6& matrix) {
  const Vector6 scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

std::optional<Matrix6> read_matrix(const XmlElement& element, const char* attribute) {
  const std::optional<std::vector<double>> numbers = element.numbers(attribute, 36, kAnyNumber);
  if (!numbers) return std::nullopt;
  return Matrix6(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(numbers->data()));
}

std::optional<MatrixSection> read_section_matrix(const XmlElement& section) {
  section.expect_only({"stiffness", "inertia"});
  const std::optional<Matrix6> stiffness = read_matrix(section, "stiffness"), inertia = read_matrix(section, "inertia");
  const std::size_t errors = section.findings().error_count();
  if (stiffness && !is_symmetric(*stiffness)) {
    section.attribute_error("stiffness", "stiffness must be symmetric");
  } else if (stiffness && !is_positive_definite(*stiffness)) {
    section.attribute_error("stiffness", "stiffness must be positive definite");
  }
  if (inertia && !is_inertia(*inertia))
    section.attribute_error(
        "inertia",
        "inertia must be [[m 1, -m d^], [m d^, J]] with mass per length m > 0, centre of mass d, and J "
        "symmetric and at least that of m at d");
  if (!stiffness || !inertia || section.findings().error_count() > errors) return std::nullopt;
  return MatrixSection{*stiffness, *inertia};
}

// ---------------------------------------------------------------- sections of any kind

constexpr const char* kSectionTags[] = {"circle", "tube", "rectangle", "box_tube", "section", "section_matrix"};
constexpr const char* kSectionExpected =
    "<circle>, <tube>, <rectangle> or <box_tube> with <material>, or <section>, or <section_matrix>";

bool is_shape(const XmlElement& section) {
  return section.tag() != "section" && section.tag() != "section_matrix";
}

/// Returns the first section among the children of `parent`; records an error for each further one.
std::optional<XmlElement> find_section(const XmlElement& parent, const std::string& has_already) {
  std::optional<XmlElement> first;
  for (const XmlElement& child : parent.children()) {
    if (std::find(std::begin(kSectionTags), std::end(kSectionTags), child.tag()) == std::end(kSectionTags)) continue;
    if (first) child.error(has_already + " has a section already, <" + first->tag() + ">");
    if (!first) first = child;
  }
  return first;
}

/// Reads a section. `material`: the beam's material, which shapes need; empty if it is missing or has errors.
std::optional<UniformSection> read_uniform(const XmlElement& section, const std::optional<Material>& material) {
  const auto widened = [](const auto& read) { return read ? std::optional<UniformSection>(*read) : std::nullopt; };
  if (section.tag() == "section") return widened(read_direct_section(section));
  if (section.tag() == "section_matrix") return widened(read_section_matrix(section));
  const std::optional<SectionShape> shape = read_shape(section);
  if (!shape || !material) return std::nullopt;
  return GeometricSection{*shape, *material};
}

/// Whether the two sections can be interpolated: they have the same kind of data, and the same shape if they have one.
bool are_alike(const UniformSection& a, const UniformSection& b) {
  if (a.index() != b.index()) return false;
  const auto *one = std::get_if<GeometricSection>(&a), *other = std::get_if<GeometricSection>(&b);
  return !one || one->shape.index() == other->shape.index();
}

std::optional<Section> read_stations(const XmlElement& stations, const std::optional<Material>& material) {
  if (stations.has("file")) return read_section_table(stations);
  stations.expect_only({}, {"station"});
  const std::size_t errors = stations.findings().error_count();
  SectionStations out;
  for (const XmlElement& station : stations.children()) {
    if (station.tag() != "station") continue;
    station.expect_only({"at"}, {"circle", "tube", "rectangle", "box_tube", "section", "section_matrix"});
    const std::optional<double> at = station.number("at", kNonNegative);
    if (at && !out.arc_lengths.empty() && !(*at > out.arc_lengths.back()))
      station.attribute_error("at", fmt::format("stations must be in the order of their arc lengths: at must be > {}",
                                                out.arc_lengths.back()));
    const std::optional<XmlElement> section = find_section(station, "the station");
    if (!section) station.error(std::string("a section is missing: ") + kSectionExpected);
    if (!at || !section) continue;
    const std::optional<UniformSection> read = read_uniform(*section, material);
    if (!read) continue;
    if (!out.sections.empty() && !are_alike(out.sections.front(), *read)) {
      section->error("all stations of a beam have the same kind of section as the first");
      continue;
    }
    out.arc_lengths.push_back(*at);
    out.sections.push_back(*read);
  }
  if (stations.findings().error_count() > errors) return std::nullopt;
  if (out.sections.size() >= 2) return out;
  // Without a material no section could be read; an error about the material is recorded already.
  if (stations.findings().error_count() == 0 || material) stations.error("at least two <station> are expected");
  return std::nullopt;
}

}  // namespace

bool is_positive_definite(const Matrix6& matrix) {
  if (!(matrix.diagonal().array() > 0).all()) return false;
  const Eigen::LLT<Matrix6> cholesky(scaled_to_unit_diagonal(matrix));
  return cholesky.info() == Eigen::Success;
}

bool is_inertia(const Matrix6& matrix) {
  const double mass = matrix(0, 0);
  const Matrix3 coupling = matrix.bottomLeftCorner<3, 3>(), rotary = matrix.bottomRightCorner<3, 3>();
  const auto small = [](const Matrix3& difference, double scale) {
    return difference.cwiseAbs().maxCoeff() <= kMatrixTolerance * scale;
  };
  if (!(mass > 0)) return false;
  if (!small(matrix.topLeftCorner<3, 3>() - mass * Matrix3::Identity(), mass)) return false;
  const double coupling_scale = coupling.cwiseAbs().maxCoeff(), rotary_scale = rotary.cwiseAbs().maxCoeff();
  if (!small(coupling + coupling.transpose(), coupling_scale)) return false;
  if (!small(matrix.topRightCorner<3, 3>() + coupling, coupling_scale)) return false;
  if (!small(rotary - rotary.transpose(), rotary_scale)) return false;
  return principal_moments(rotary + coupling * coupling / mass)[0] >= -kMatrixTolerance * rotary_scale;
}

std::optional<Section> read_section(const XmlElement& beam) {
  const std::optional<XmlElement> section = find_section(beam, "the beam"), stations = beam.child("stations"),
                                  material_element = beam.child("material");
  if (section && stations) stations->error("the beam has a section already, <" + section->tag() + ">");
  bool has_shape = section && is_shape(*section),
       has_others = (section && !has_shape) || (stations && stations->has("file"));
  for (const XmlElement& station : stations ? stations->children() : std::vector<XmlElement>())
    for (const XmlElement& child : station.children()) (is_shape(child) ? has_shape : has_others) = true;

  std::optional<Material> material;
  if (material_element && !has_others) material = read_material(*material_element);
  if (!section && !stations) {
    beam.error(std::string("a section is missing: ") + kSectionExpected + ", or <stations>");
    return std::nullopt;
  }
  if (material_element && has_others)
    material_element->error("<" + (section ? *section : *stations).tag() + "> leaves no place for a material");
  if (has_shape && !material_element) beam.error("<material> is missing");
  if (!section) return read_stations(*stations, material);
  const std::optional<UniformSection> read = read_uniform(*section, material);
  if (!read) return std::nullopt;
  return std::visit([](const auto& s) -> Section { return s; }, *read);
}

}  // namespace flexarm::scene
