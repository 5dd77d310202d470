#include "building/section.h"

#include <algorithm>
#include <cmath>

#include "math/pi.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Area [m^2], second moments and torsion constant [m^4], shear correction factors, edge distance, and extents along y
/// and z [m] of a shape.
struct Geometry {
  double area, i2, i3, torsion, k2, k3, radius, along_y, along_z;
};

Geometry geometry(const scene::Circle& circle, double nu) {
  const double r2 = circle.radius * circle.radius;
  const double i = kPi / 4 * r2 * r2;
  const double k = 6 * (1 + nu) / (7 + 6 * nu);
  return {kPi * r2, i, i, 2 * i, k, k, circle.radius, 2 * circle.radius, 2 * circle.radius};
}

Geometry geometry(const scene::Tube& tube, double nu) {
  const double ro = tube.outer_radius, ri = tube.inner_radius, m = ri / ro;
  const double area = kPi * (ro * ro - ri * ri);
  const double i = kPi / 4 * (std::pow(ro, 4) - std::pow(ri, 4));
  const double q = (1 + m * m) * (1 + m * m);
  const double k = 6 * (1 + nu) * q / ((7 + 6 * nu) * q + (20 + 12 * nu) * m * m);
  return {area, i, i, 2 * i, k, k, ro, 2 * ro, 2 * ro};
}

/// Saint-Venant's torsion constant of a rectangle [m^4] by his series, to round-off: docs/notes/beam.md, 2.1.
double rectangle_torsion(double width, double height) {
  constexpr double kSumForThin = 31.0 / 32 * 1.0369277551433699;  // of n^-5 over odd n: 31/32 of zeta(5)
  const double a = std::max(width, height), b = std::min(width, height);
  double sum = kSumForThin;  // becomes that of tanh(n pi a / 2b) n^-5; tanh x = 1 - 2 / (e^2x + 1)
  for (int n = 1; n <= 11; n += 2) sum -= 2 / ((std::exp(n * kPi * a / b) + 1) * std::pow(n, 5));
  return a * b * b * b * (1.0 / 3 - 64 / std::pow(kPi, 5) * b / a * sum);
}

Geometry geometry(const scene::Rectangle& rectangle, double nu) {
  const double w = rectangle.width, h = rectangle.height;
  const double torsion = rectangle_torsion(w, h);
  const double k = 10 * (1 + nu) / (12 + 11 * nu);
  return {w * h, w * h * h * h / 12, h * w * w * w / 12, torsion, k, k, 0.5 * std::hypot(w, h), w, h};
}

/// Cowper's factor of a thin box for shear along the webs: b flange length, h web length, equal thickness.
double thin_box_shear_factor(double b, double h, double nu) {
  const double m = b / h, n = b / h, m2 = m * m, m3 = m2 * m;
  return 10 * (1 + nu) * (1 + 3 * m) * (1 + 3 * m) /
         (12 + 72 * m + 150 * m2 + 90 * m3 + nu * (11 + 66 * m + 135 * m2 + 90 * m3) +
          10 * n * n * ((3 + nu) * m + 3 * m2));
}

Geometry geometry(const scene::BoxTube& box, double nu) {
  const double w = box.width, h = box.height, t = box.thickness, wi = w - 2 * t, hi = h - 2 * t;
  const double wm = w - t, hm = h - t;  // mid-wall lengths: Bredt's and Cowper's formulas are for thin walls
  return {w * h - wi * hi,
          (w * h * h * h - wi * hi * hi * hi) / 12,
          (h * w * w * w - hi * wi * wi * wi) / 12,
          4 * wm * wm * hm * hm * t / (2 * (wm + hm)),
          thin_box_shear_factor(hm, wm, nu),
          thin_box_shear_factor(wm, hm, nu),
          0.5 * std::hypot(w, h),
          w,
          h};
}

SectionProperties convert(const scene::GeometricSection& section) {
  const scene::Material& material = section.material;
  const Geometry g = std::visit([&](const auto& shape) { return geometry(shape, material.poisson); }, section.shape);
  const double shear_modulus = material.young / (2 * (1 + material.poisson));
  SectionProperties out;
  Vector6 stiffness;
  stiffness << material.young * g.area, g.k2 * shear_modulus * g.area, g.k3 * shear_modulus * g.area,
      shear_modulus * g.torsion, material.young * g.i2, material.young * g.i3;
  out.stiffness = stiffness.asDiagonal();
  out.mass = material.density * g.area;
  out.inertia =
      Vector3(material.density * (g.i2 + g.i3), material.density * g.i2, material.density * g.i3).asDiagonal();
  out.radius = g.radius;
  out.extent = {g.along_y, g.along_z};
  return out;
}

/// Display radius of a section whose shape is unknown: that of a tube-like section with the same radius of gyration.
double radius_from(const Matrix6& stiffness) {
  const double ea = stiffness(0, 0), ei = std::max(stiffness(4, 4), stiffness(5, 5));
  return 2 * std::sqrt(ei / ea);
}

SectionProperties convert(const scene::DirectSection& s) {
  SectionProperties out;
  Vector6 stiffness;
  stiffness << s.ea, s.ga2, s.ga3, s.gj, s.ei2, s.ei3;
  out.stiffness = stiffness.asDiagonal();
  out.mass = s.mass;
  out.inertia = Vector3(s.j1, s.j2, s.j3).asDiagonal();
  out.radius = radius_from(out.stiffness);
  return out;
}

SectionProperties convert(const scene::MatrixSection& s) {
  SectionProperties out;
  out.stiffness = 0.5 * (s.stiffness + s.stiffness.transpose());
  out.mass = s.inertia.topLeftCorner<3, 3>().trace() / 3;
  const Matrix3 coupling = s.inertia.bottomLeftCorner<3, 3>() / out.mass;  // = d^
  out.center_of_mass =
      0.5 * Vector3(coupling(2, 1) - coupling(1, 2), coupling(0, 2) - coupling(2, 0), coupling(1, 0) - coupling(0, 1));
  const Matrix3 d = so3::hat(out.center_of_mass);
  const Matrix3 about_reference = s.inertia.bottomRightCorner<3, 3>();
  out.inertia = 0.5 * (about_reference + about_reference.transpose()) + out.mass * d * d;
  out.radius = radius_from(out.stiffness);
  return out;
}

// ---------------------------------------------------------------- between two stations

double blend(double a, double b, double t) {
  return (1 - t) * a + t * b;
}
Matrix6 blend(const Matrix6& a, const Matrix6& b, double t) {
  return (1 - t) * a + t * b;
}
scene::Circle blend(const scene::Circle& a, const scene::Circle& b, double t) {
  return {blend(a.radius, b.radius, t)};
}
scene::Tube blend(const scene::Tube& a, const scene::Tube& b, double t) {
  return {blend(a.outer_radius, b.outer_radius, t), blend(a.inner_radius, b.inner_radius, t)};
}
scene::Rectangle blend(const scene::Rectangle& a, const scene::Rectangle& b, double t) {
  return {blend(a.width, b.width, t), blend(a.height, b.height, t)};
}
scene::BoxTube blend(const scene::BoxTube& a, const scene::BoxTube& b, double t) {
  return {blend(a.width, b.width, t), blend(a.height, b.height, t), blend(a.thickness, b.thickness, t)};
}
scene::DirectSection blend(const scene::DirectSection& a, const scene::DirectSection& b, double t) {
  return {blend(a.ea, b.ea, t),   blend(a.ga2, b.ga2, t), blend(a.ga3, b.ga3, t),   blend(a.gj, b.gj, t),
          blend(a.ei2, b.ei2, t), blend(a.ei3, b.ei3, t), blend(a.mass, b.mass, t), blend(a.j1, b.j1, t),
          blend(a.j2, b.j2, t),   blend(a.j3, b.j3, t)};
}
scene::MatrixSection blend(const scene::MatrixSection& a, const scene::MatrixSection& b, double t) {
  return {blend(a.stiffness, b.stiffness, t), blend(a.inertia, b.inertia, t)};
}

scene::GeometricSection blend(const scene::GeometricSection& a, const scene::GeometricSection& b, double t);

/// Blends two variants that hold the same type.
template <class Variant>
Variant blend_alike(const Variant& a, const Variant& b, double t) {
  return std::visit([&](const auto& one) -> Variant { return blend(one, std::get<std::decay_t<decltype(one)>>(b), t); },
                    a);
}
scene::GeometricSection blend(const scene::GeometricSection& a, const scene::GeometricSection& b, double t) {
  return {blend_alike(a.shape, b.shape, t), a.material};
}

}  // namespace

SectionProperties section_properties(const scene::UniformSection& section) {
  return std::visit([](const auto& s) { return convert(s); }, section);
}

SectionProperties referred_to_center_of_mass(const SectionProperties& section) {
  if (section.center_of_mass.isZero(0)) return section;
  Matrix6 transform = Matrix6::Identity();  // {Gamma, K} at the reference line from those at the centroid
  transform.topRightCorner<3, 3>() = so3::hat(section.center_of_mass);
  SectionProperties out = section;
  out.stiffness = transform.transpose() * section.stiffness * transform;
  out.center_of_mass.setZero();
  return out;
}

SectionLine::SectionLine(const scene::Section& section) {
  std::visit(
      [&](const auto& s) {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, scene::SectionStations>) {
          stations_ = s;
        } else {
          uniform_ = convert(s);
        }
      },
      section);
}

double SectionLine::largest_radius() const {
  double radius = at(0).radius;
  for (const double s : stations()) radius = std::max(radius, at(s).radius);
  return radius;
}

SectionProperties SectionLine::at(double arc_length) const {
  if (uniform_) return *uniform_;
  const std::vector<double>& s = stations_.arc_lengths;
  const auto next = std::upper_bound(s.begin(), s.end(), arc_length);
  if (next == s.begin()) return section_properties(stations_.sections.front());
  if (next == s.end()) return section_properties(stations_.sections.back());
  const std::size_t k = next - s.begin();
  return section_properties(
      blend_alike(stations_.sections[k - 1], stations_.sections[k], (arc_length - s[k - 1]) / (s[k] - s[k - 1])));
}

}  // namespace flexarm
