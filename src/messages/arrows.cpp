#include "messages/arrows.h"

#include <algorithm>
#include <cmath>

#include "messages/markers.h"

namespace flexarm::messages {
namespace {

// Per radius of the scene.
constexpr double kShaft = 0.006, kHead = 0.018, kHeadLength = 0.06;
/// Per length of the longest arrow; shorter arrows are not drawn.
constexpr double kShortest = 0.02;
/// Smaller forces and moments are round-off in any scene [N, N m].
constexpr double kSmallest = 1e-6;
/// Angle of a moment's circular arrow, including its head [rad].
constexpr double kTurn = 1.6 * M_PI;
constexpr int kArcs = 24;

/// A tube that ends in a cone, kHeadLength long. `at(part)`: the section at the fraction `part` of the length.
template <class At>
TriangleMesh arrow_along(const At& at, double length, int parts, double radius) {
  const double head = std::min(kHeadLength * radius, 0.5 * length), neck = 1 - head / length;
  const double thickness = std::min(1.0, head / (kHeadLength * radius));
  std::vector<Pose> sections;
  std::vector<double> radii;
  const auto add = [&](double part, double section_radius) {
    sections.push_back(at(part));
    radii.push_back(thickness * section_radius * radius);
  };
  for (int k = 0; k <= parts; ++k) add(neck * k / parts, kShaft);
  add(neck, kHead);
  add(1, 0);
  return tube_mesh(sections, radii);
}

TriangleMesh force_arrow(const Vector3& start, const Vector3& way, double radius) {
  const Quaternion along = Quaternion::FromTwoVectors(Vector3::UnitX(), way);
  return arrow_along([&](double part) { return Pose{start + part * way, along}; }, way.norm(), 1, radius);
}

/// A circular arrow around `axis` with the radius `circle`; `radius`: of the scene.
TriangleMesh moment_arrow(const Vector3& center, const Vector3& axis, double circle, double radius) {
  const Quaternion upright = Quaternion::FromTwoVectors(Vector3::UnitZ(), axis);
  const auto at = [&](double part) {
    const Quaternion turned = upright * Quaternion(Eigen::AngleAxisd(part * kTurn, Vector3::UnitZ()));
    const Quaternion tangent(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ()));
    return Pose{center + turned * (circle * Vector3::UnitX()), turned * tangent};
  };
  return arrow_along(at, kTurn * circle, kArcs, radius);
}

/// Fraction of the largest amount; 0 if the arrow would be too small to be seen.
double shown_part(double amount, double largest) {
  const double part = largest > kSmallest ? amount / largest : 0.0;
  return part < kShortest ? 0 : part;
}

}  // namespace

void ArrowScale::note(const std::vector<ActingWrench>& wrenches) {
  for (const ActingWrench& acting : wrenches) {
    force = std::max(force, acting.wrench.force.norm());
    moment = std::max(moment, acting.wrench.moment.norm());
  }
}

TriangleMesh arrow_mesh(const ActingWrench& wrench, const ArrowScale& scale, double radius) {
  const auto& [force, moment] = wrench.wrench;
  TriangleMesh mesh;
  if (const double part = shown_part(force.norm(), scale.force); part > 0)
    mesh.add(force_arrow(wrench.position, kLongestArrow * radius * part * force.normalized(), radius), Pose());
  if (const double part = shown_part(moment.norm(), scale.moment); part > 0)
    mesh.add(moment_arrow(wrench.position, moment, kLargestCircle * radius * part, radius), Pose());
  return mesh;
}

void add_arrows(const std_msgs::Header& header, const std::string& name, const std::vector<ActingWrench>& wrenches,
                const ArrowScale& scale, double radius, const std_msgs::ColorRGBA& color,
                visualization_msgs::MarkerArray& message) {
  visualization_msgs::Marker marker = make_marker(header, name, visualization_msgs::Marker::TRIANGLE_LIST);
  marker.color = color;
  for (const ActingWrench& wrench : wrenches) draw(arrow_mesh(wrench, scale, radius), marker);
  add_if_any(std::move(marker), message);
}

}  // namespace flexarm::messages
