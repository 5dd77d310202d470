#include "contact/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "math/pi.h"

namespace flexarm {
namespace {

/// The norm of a vector, with its derivatives. If the vector is zero, the gradient is `otherwise`.
SignedDistance norm(const Vector3& vector, const Vector3& otherwise) {
  SignedDistance out;
  out.value = vector.norm();
  if (out.value == 0) {
    out.gradient = otherwise;
    return out;
  }
  out.gradient = vector / out.value;
  out.hessian = (Matrix3::Identity() - out.gradient * out.gradient.transpose()) / out.value;
  return out;
}

/// The signed distance of the octant x, y, z < 0 of axes along the columns of `axes`. `faces`: signed distances from
/// its three faces.
SignedDistance corner(const Vector3& faces, const Matrix3& axes) {
  Eigen::Index nearest;
  const double highest = faces.maxCoeff(&nearest);
  if (highest <= 0) return {highest, axes.col(nearest), Matrix3::Zero()};
  const Vector3 outside = faces.cwiseMax(0.0);
  const SignedDistance local = norm(outside, Vector3::UnitZ());
  // Motions normal to faces that the point is inside of do not change the distance.
  const Vector3 counts = (faces.array() > 0).cast<double>();
  const Matrix3 hessian = counts.asDiagonal() * local.hessian * counts.asDiagonal();
  return {local.value, axes * local.gradient, axes * hessian * axes.transpose()};
}

SignedDistance distance_of(const HalfSpace&, const Vector3& y) {
  return {y.z(), Vector3::UnitZ(), Matrix3::Zero()};
}

SignedDistance distance_of(const Ball& ball, const Vector3& y) {
  SignedDistance out = norm(y, Vector3::UnitZ());
  out.value -= ball.radius;
  return out;
}

SignedDistance distance_of(const Box& box, const Vector3& y) {
  const Vector3 signs = y.unaryExpr([](double each) { return each < 0 ? -1.0 : 1.0; });
  return corner(y.cwiseAbs() - box.half, signs.asDiagonal());
}

/// The signed distance from a body of revolution about z, whose section is a rectangle. `radial`: the distance from the
/// axis; `beside`: the same from the middle of the section; `half`, `half_length`: half of its width and height [m].
SignedDistance about_axis(const SignedDistance& radial, double beside, double half, double half_length,
                          const Vector3& y) {
  const Vector3 outwards = (beside < 0 ? -1 : 1) * radial.gradient;
  Matrix3 axes;
  axes << outwards, Vector3::UnitZ().cross(radial.gradient), Vector3(0, 0, y.z() < 0 ? -1 : 1);
  SignedDistance out =
      corner({std::abs(beside) - half, -std::numeric_limits<double>::infinity(), std::abs(y.z()) - half_length}, axes);
  // The radial direction rotates as the point moves.
  const double radial_part = out.gradient.dot(radial.gradient);
  Matrix3 in_section = radial.hessian;
  in_section.row(2).setZero(), in_section.col(2).setZero();
  out.hessian += radial_part * in_section;
  return out;
}

SignedDistance distance_of(const Cylinder& cylinder, const Vector3& y) {
  const SignedDistance radial = norm({y.x(), y.y(), 0}, Vector3::UnitX());
  return about_axis(radial, radial.value, cylinder.radius, cylinder.half_length, y);
}

/// In a plane with the axis, a tube's wall is a rectangle.
SignedDistance distance_of(const Tube& tube, const Vector3& y) {
  const SignedDistance radial = norm({y.x(), y.y(), 0}, Vector3::UnitX());
  const double middle = 0.5 * (tube.radius + tube.inner_radius), half = 0.5 * (tube.radius - tube.inner_radius);
  return about_axis(radial, radial.value - middle, half, tube.half_length, y);
}

/// The face with the largest signed distance from a point, and this distance [m].
struct HighestFace {
  const Polytope::Face* face;
  double height;
};
HighestFace highest_face(const Hull& hull, const Vector3& y) {
  HighestFace out{nullptr, -std::numeric_limits<double>::infinity()};
  for (const Polytope::Face& face : hull.polytope->faces)
    if (const double height = height_over(face, y); height > out.height) out = {&face, height};
  return out;
}

SignedDistance distance_of(const Hull& hull, const Vector3& y) {
  const auto [highest, height] = highest_face(hull, y);
  if (height <= 0) return {height, highest->normal, Matrix3::Zero()};
  const NearestPoint nearest = nearest_point(*hull.polytope, y);
  if (nearest.dimensions == 2) return {height, highest->normal, Matrix3::Zero()};
  SignedDistance out = norm(y - nearest.position, highest->normal);
  out.hessian -= nearest.along * nearest.along.transpose() / out.value;
  return out;
}

/// The value of corner(), without derivatives.
template <class Faces>
double corner_gap(const Faces& faces) {
  const double highest = faces.maxCoeff();
  return highest <= 0 ? highest : faces.cwiseMax(0.0).norm();
}

// gap_of() returns signed distances without derivatives. Outside a hull, beside its faces, it returns less than the
// distance.
double gap_of(const HalfSpace&, const Vector3& y) {
  return y.z();
}
double gap_of(const Ball& ball, const Vector3& y) {
  return y.norm() - ball.radius;
}
double gap_of(const Box& box, const Vector3& y) {
  return corner_gap(Vector3(y.cwiseAbs() - box.half));
}
double gap_of(const Cylinder& cylinder, const Vector3& y) {
  return corner_gap(Eigen::Vector2d(y.head<2>().norm() - cylinder.radius, std::abs(y.z()) - cylinder.half_length));
}
double gap_of(const Tube& tube, const Vector3& y) {
  const double middle = 0.5 * (tube.radius + tube.inner_radius), half = 0.5 * (tube.radius - tube.inner_radius);
  return corner_gap(Eigen::Vector2d(std::abs(y.head<2>().norm() - middle) - half, std::abs(y.z()) - tube.half_length));
}
double gap_of(const Hull& hull, const Vector3& y) {
  return highest_face(hull, y).height;
}

/// Appends contact points between both ends of an edge. If these are too far apart for the spacing, also a segment: the
/// axis of a cylinder that nearly touches both faces from the inside. `radius`: of this cylinder [m].
void add_edge_points(const Vector3& begin, const Vector3& end, double spacing, const Matrix3& outwards, double radius,
                     std::vector<ContactPoint>& points) {
  const double length = (end - begin).norm();
  const int spans = static_cast<int>(std::min(std::ceil(length / spacing), kMostEdgePoints + 1.0));
  for (int i = 1; i < spans; ++i) points.push_back({begin + (end - begin) * i / spans, 0, outwards});
  if (length <= spacing * (kMostEdgePoints + 1) || !(radius > 0)) return;
  const Vector3 out = outwards.rowwise().sum();  // of two unit normals; its square is 2 (1 + cosine)
  ContactPoint segment{0.5 * (begin + end) - 2 * (1 + kSunkEdge) * radius / out.squaredNorm() * out, radius};
  segment.half = 0.5 * length;
  segment.curvature = kBentEdge * radius / (segment.half * segment.half);
  segment.axis = (end - begin) / length;
  points.push_back(segment);
}

std::vector<ContactPoint> points_of(const HalfSpace&, double, bool) {
  return {};
}
std::vector<ContactPoint> points_of(const Ball& ball, double, bool) {
  return {{Vector3::Zero(), ball.radius}};
}
std::vector<ContactPoint> points_of(const Box& box, double spacing, bool) {
  std::vector<ContactPoint> out;
  for (int k = 0; k < 8; ++k) {
    const Vector3 corner = box.half.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
    const Matrix3 outwards = corner.cwiseSign().asDiagonal();
    out.push_back({corner, 0, outwards});
    for (int axis = 0; axis < 3; ++axis) {
      if (k & (1 << axis)) continue;  // each edge is added at its lower end
      Matrix3 beside = outwards;
      beside.col(axis).setZero();
      add_edge_points(corner, corner + 2 * box.half[axis] * Vector3::Unit(axis), spacing, beside,
                      kRoundEdge * box.half.minCoeff(), out);
    }
  }
  return out;
}
/// Returns the normals of the faces that meet in a corner or edge as columns. If there are more than three, returns
/// their mean direction as the only column.
Matrix3 outwards_of(const std::vector<Vector3>& normals) {
  Matrix3 out = Matrix3::Zero();
  if (normals.size() <= 3)
    for (std::size_t i = 0; i < normals.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = normals[i];
  else
    out.col(0) = std::accumulate(normals.begin(), normals.end(), Vector3(Vector3::Zero())).normalized();
  return out;
}

std::vector<ContactPoint> points_of(const Hull& hull, double spacing, bool) {
  const std::vector<Vector3>& corners = hull.polytope->corners;
  std::vector<std::vector<Vector3>> at_corners(corners.size());
  std::map<std::pair<int, int>, std::vector<Vector3>> at_edges;  // by edge: the normals of its two faces
  for (const Polytope::Face& face : hull.polytope->faces)
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int begin = face.corners[i], end = face.corners[(i + 1) % face.corners.size()];
      at_corners[begin].push_back(face.normal);
      at_edges[std::minmax(begin, end)].push_back(face.normal);
    }
  std::vector<ContactPoint> out;
  for (std::size_t i = 0; i < corners.size(); ++i) out.push_back({corners[i], 0, outwards_of(at_corners[i])});
  const double radius = kRoundEdge * inner_radius(*hull.polytope);
  for (const auto& [edge, normals] : at_edges)
    add_edge_points(corners[edge.first], corners[edge.second], spacing, outwards_of(normals), radius, out);
  return out;
}
/// Appends points on a circle about z. `side`: 1 for an outer rim, -1 for an inner one.
void add_circle(double radius, double z, double side, double share, std::vector<ContactPoint>& points) {
  for (int k = 0; k < kRimPoints; ++k) {
    const double angle = 2 * kPi * k / kRimPoints;
    const Vector3 radial(std::cos(angle), std::sin(angle), 0);
    Matrix3 outwards = Matrix3::Zero();
    outwards.col(0) = side * radial;
    outwards(2, 2) = z < 0 ? -1 : 1;
    points.push_back({radius * radial + Vector3(0, 0, z), 0, outwards, share});
  }
}
/// Returns the points of a tube, or with an inner radius of 0 those of both faces of a cylinder.
std::vector<ContactPoint> points_of(const Tube& tube, double, bool on_flat) {
  const double r = tube.radius, bore = tube.inner_radius;
  // The mean arm of what resists spinning under a uniform pressure.
  const double arm = 2.0 / 3 * (r * r + r * bore + bore * bore) / (r + bore), inner = (1 - kDrawnIn) * r;
  const double share = arm / std::max(inner, arm);
  std::vector<ContactPoint> out;
  for (const double z : {-tube.half_length, tube.half_length}) {
    add_circle(on_flat ? inner : r, z, 1, on_flat ? share : 1, out);
    if (on_flat) out.push_back({{0, 0, z}, 0, Matrix3::Zero(), std::max(1 - share, 0.3) * kRimPoints, r});
    if (!on_flat && bore > 0) add_circle(bore, z, -1, 1, out);
  }
  return out;
}
std::vector<ContactPoint> points_of(const Cylinder& cylinder, double spacing, bool on_flat) {
  std::vector<ContactPoint> out = points_of(Tube{cylinder.radius, 0, cylinder.half_length}, spacing, on_flat);
  // For the side: balls along the axis with the cylinder's radius.
  const double end = cylinder.half_length - cylinder.radius;
  if (end <= 0) return out;
  const int spans = std::max(1, static_cast<int>(std::min(std::ceil(2 * end / spacing), kMostEdgePoints + 1.0)));
  for (int i = 0; i <= spans; ++i) out.push_back({{0, 0, end * (2.0 * i / spans - 1)}, cylinder.radius});
  // Where something crosses the side, the nearest point of the axis carries it alone.
  ContactPoint axis{Vector3::Zero(), cylinder.radius};

  axis.half = end;
  axis.curvature = kBarrel * cylinder.radius / (end * end);
  out.push_back(axis);
  return out;
}

}  // namespace

SignedDistance ContactShape::distance(const Vector3& point) const {
  const Matrix3 axes = place.orientation.toRotationMatrix();
  if (std::holds_alternative<HalfSpace>(kind) && !is_hollow)
    return {axes.col(2).dot(point - place.position), axes.col(2), Matrix3::Zero()};
  const Vector3 own = axes.transpose() * (point - place.position);
  SignedDistance out = std::visit([&](const auto& shape) { return distance_of(shape, own); }, kind);
  const double sign = is_hollow ? -1 : 1;
  out.value *= sign;
  out.gradient = sign * (axes * out.gradient);
  out.hessian = sign * (axes * out.hessian * axes.transpose());
  return out;
}

double ContactShape::gap(const Vector3& point) const {
  const Vector3 own = place.orientation.conjugate() * (point - place.position);
  const double value = std::visit([&](const auto& shape) { return gap_of(shape, own); }, kind);
  return is_hollow ? -value : value;
}

double half_width(const ContactShape& shape) {
  if (const auto* ball = std::get_if<Ball>(&shape.kind)) return ball->radius;
  if (const auto* box = std::get_if<Box>(&shape.kind)) return box->half.minCoeff();
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.kind))
    return std::min(cylinder->radius, cylinder->half_length);
  if (const auto* hull = std::get_if<Hull>(&shape.kind)) return inner_radius(*hull->polytope);
  if (const auto* tube = std::get_if<Tube>(&shape.kind))
    return std::min(0.5 * (tube->radius - tube->inner_radius), tube->half_length);
  return std::numeric_limits<double>::infinity();
}

double bounding_radius(const ContactShape& shape) {
  if (const auto* ball = std::get_if<Ball>(&shape.kind)) return ball->radius;
  if (const auto* box = std::get_if<Box>(&shape.kind)) return box->half.norm();
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.kind))
    return std::hypot(cylinder->radius, cylinder->half_length);
  if (const auto* tube = std::get_if<Tube>(&shape.kind)) return std::hypot(tube->radius, tube->half_length);
  if (const auto* hull = std::get_if<Hull>(&shape.kind)) {
    double square = 0;
    for (const Vector3& corner : hull->polytope->corners) square = std::max(square, corner.squaredNorm());
    return std::sqrt(square);
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<ContactPoint> contact_points(const ContactShape& shape, double spacing, bool on_flat) {
  if (shape.is_hollow) return {};
  std::vector<ContactPoint> out =
      std::visit([&](const auto& each) { return points_of(each, spacing, on_flat); }, shape.kind);
  const Matrix3 axes = shape.place.orientation.toRotationMatrix();
  for (ContactPoint& point : out) {
    point.arm = shape.place * point.arm;
    point.outwards = axes * point.outwards;
    point.axis = axes * point.axis;
  }
  return out;
}

}  // namespace flexarm
