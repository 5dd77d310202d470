#include "contact/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/pi.h"

namespace flexarm {
namespace {

/// Of the norm of a vector. Where it vanishes, `otherwise` is as good a direction as any.
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

/// Of the corner region x, y, z < 0 of axes along `axes`, from the distances of its faces.
SignedDistance corner(const Vector3& faces, const Matrix3& axes) {
  Eigen::Index nearest;
  const double highest = faces.maxCoeff(&nearest);
  if (highest <= 0) return {highest, axes.col(nearest), Matrix3::Zero()};
  const Vector3 outside = faces.cwiseMax(0.0);
  const SignedDistance local = norm(outside, Vector3::UnitZ());
  // Along faces that the point is inside of, nothing changes.
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

SignedDistance distance_of(const Cylinder& cylinder, const Vector3& y) {
  const SignedDistance radial = norm({y.x(), y.y(), 0}, Vector3::UnitX());
  Matrix3 axes;
  axes << radial.gradient, Vector3::UnitZ().cross(radial.gradient), Vector3(0, 0, y.z() < 0 ? -1 : 1);
  const double face = radial.value - cylinder.radius;
  SignedDistance out =
      corner({face, -std::numeric_limits<double>::infinity(), std::abs(y.z()) - cylinder.half_length}, axes);
  // The radial axis turns with the point.
  const double radial_part = out.gradient.dot(radial.gradient);
  Matrix3 in_section = radial.hessian;
  in_section.row(2).setZero(), in_section.col(2).setZero();
  out.hessian += radial_part * in_section;
  return out;
}

std::vector<ContactPoint> points_of(const HalfSpace&, double) {
  return {};
}
std::vector<ContactPoint> points_of(const Ball& ball, double) {
  return {{Vector3::Zero(), ball.radius}};
}
std::vector<ContactPoint> points_of(const Box& box, double spacing) {
  std::vector<ContactPoint> out;
  for (int k = 0; k < 8; ++k) {
    const Vector3 corner = box.half.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
    const Matrix3 outwards = corner.cwiseSign().asDiagonal();
    out.push_back({corner, 0, outwards});
    for (int axis = 0; axis < 3; ++axis) {
      if (k & (1 << axis)) continue;  // edges begin at their lower ends
      const double length = 2 * box.half[axis];
      const int between = static_cast<int>(std::min(std::ceil(length / spacing), kMostEdgePoints + 1.0)) - 1;
      Matrix3 beside = outwards;
      beside.col(axis).setZero();
      for (int i = 1; i <= between; ++i)
        out.push_back({corner + length * i / (between + 1) * Vector3::Unit(axis), 0, beside});
    }
  }
  return out;
}
std::vector<ContactPoint> points_of(const Cylinder& cylinder, double) {
  std::vector<ContactPoint> out;
  for (const double z : {-cylinder.half_length, cylinder.half_length})
    for (int k = 0; k < kRimPoints; ++k) {
      const double angle = 2 * kPi * k / kRimPoints;
      const Vector3 radial(std::cos(angle), std::sin(angle), 0);
      Matrix3 outwards = Matrix3::Zero();
      outwards.col(0) = radial;
      outwards(2, 2) = z < 0 ? -1 : 1;
      out.push_back({cylinder.radius * radial + Vector3(0, 0, z), 0, outwards});
    }
  return out;
}

}  // namespace

SignedDistance ContactShape::distance(const Vector3& point) const {
  const Matrix3 axes = place.orientation.toRotationMatrix();
  const Vector3 own = axes.transpose() * (point - place.position);
  SignedDistance out = std::visit([&](const auto& shape) { return distance_of(shape, own); }, kind);
  out.gradient = axes * out.gradient;
  out.hessian = axes * out.hessian * axes.transpose();
  return out;
}

double ContactShape::gap(const Vector3& point) const {
  const Vector3 own = place.orientation.conjugate() * (point - place.position);
  return std::visit([&](const auto& shape) { return distance_of(shape, own).value; }, kind);
}

// ---------------------------------------------------------------- faces

namespace {

/// A point may be beside a face by this part of its shape's size, and still be over it: round-off.
constexpr double kBeside = 1e-9;
/// A point that starts so little inside of a face, of the size, may come in by it: corners of equal boxes that a scene
/// lays on each other are inside of several.
constexpr double kFlush = 1e-3;
/// Cosines of a face's normal to those of the faces that meet in a corner that lies on it: not above the first, and one
/// of them below the second.
constexpr double kAside = 0.2, kOpposite = -0.5;

/// How far a point is outside of each pair of faces on the side on which `side` is, and the size of it all [m].
struct FaceDistances {
  Vector3 values;
  double size;
};
FaceDistances face_distances(const ContactShape& shape, const Vector3& point, const Vector3& side) {
  if (const auto* box = std::get_if<Box>(&shape.kind)) {
    const Vector3 signs = side.unaryExpr([](double each) { return each < 0 ? -1.0 : 1.0; });
    return {point.cwiseProduct(signs) - box->half, box->half.maxCoeff()};
  }
  const Cylinder& cylinder = std::get<Cylinder>(shape.kind);
  const double radial = point.head<2>().norm() - cylinder.radius;
  return {{radial, radial, (side.z() < 0 ? -point.z() : point.z()) - cylinder.half_length},
          std::max(cylinder.radius, cylinder.half_length)};
}

/// Of an axis, on the side of a point.
int face_along(const ContactShape& shape, Eigen::Index axis, const Vector3& side) {
  if (std::holds_alternative<Cylinder>(shape.kind) && axis < 2) return 1;
  const int number = static_cast<int>(axis) + 1;
  return side[axis] < 0 ? -number : number;
}

bool is_round(const ContactShape& shape, int face) {
  return std::holds_alternative<Cylinder>(shape.kind) && face == 1;
}

bool is_same_pair(const ContactShape& shape, Eigen::Index one, Eigen::Index other) {
  return one == other || (std::holds_alternative<Cylinder>(shape.kind) && one < 2 && other < 2);
}

Vector3 own_point(const ContactShape& shape, const Vector3& point) {
  return shape.place.orientation.conjugate() * (point - shape.place.position);
}

}  // namespace

bool has_faces(const ContactShape& shape) {
  return std::holds_alternative<Box>(shape.kind) || std::holds_alternative<Cylinder>(shape.kind);
}

int entered_face(const ContactShape& shape, const Vector3& from, const Vector3& to) {
  const Vector3 begin = own_point(shape, from), end = own_point(shape, to);
  const FaceDistances first = face_distances(shape, begin, begin), last = face_distances(shape, end, begin);
  const double slack = kBeside * first.size;
  double entry = -1;  // the last of the pairs of faces between which the point comes, in parts of the way
  Eigen::Index axis = -1;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double a = first.values[k], b = last.values[k];
    if (a < -kFlush * first.size) continue;
    if (a > slack && b >= a) return 0;
    // Where it starts on several faces it comes in by the one towards which it moves.
    const double part = a > slack ? a / (a - b) : 0;
    if (part < entry || (part == entry && b >= last.values[axis])) continue;
    entry = part;
    axis = k;
  }
  if (axis < 0 || entry > 1) return 0;
  const int face = face_along(shape, axis, begin);
  return is_over_face(shape, face, from + entry * (to - from)) ? face : 0;
}

int nearest_face(const ContactShape& shape, const Vector3& point) {
  const Vector3 own = own_point(shape, point);
  Eigen::Index axis;
  face_distances(shape, own, own).values.maxCoeff(&axis);
  return face_along(shape, axis, own);
}

bool can_lie_on(const ContactShape& shape, int face, const Matrix3& outwards) {
  if (is_round(shape, face)) return true;
  const Vector3 normal = beyond_face(shape, face).place.orientation * Vector3::UnitZ();
  const Vector3 cosines = outwards.transpose() * normal;
  return cosines.maxCoeff() <= kAside && cosines.minCoeff() <= kOpposite;
}

int face_to_lie_on(const ContactShape& shape, int crossed, const Vector3& point, const Matrix3& outwards,
                   double deepest) {
  const Vector3 own = own_point(shape, point);
  const FaceDistances distances = face_distances(shape, own, own);
  int best = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const int face = face_along(shape, k, own);
    const double distance = std::abs(distances.values[k]);
    if (face == crossed || is_round(shape, face) || distance > deepest || !can_lie_on(shape, face, outwards)) continue;
    best = face;
    deepest = distance;
  }
  return best;
}

bool is_over_face(const ContactShape& shape, int face, const Vector3& point) {
  const Vector3 own = own_point(shape, point);
  const FaceDistances distances = face_distances(shape, own, own);
  for (Eigen::Index k = 0; k < 3; ++k)
    if (!is_same_pair(shape, k, std::abs(face) - 1) && distances.values[k] > kBeside * distances.size) return false;
  return true;
}

ContactShape beyond_face(const ContactShape& shape, int face) {
  const Eigen::Index axis = std::abs(face) - 1;
  const auto* cylinder = std::get_if<Cylinder>(&shape.kind);
  if (cylinder && axis < 2) return {Cylinder{cylinder->radius, std::numeric_limits<double>::infinity()}, shape.place};
  const double half = cylinder ? cylinder->half_length : std::get<Box>(shape.kind).half[axis];
  const Vector3 outwards = (face < 0 ? -1.0 : 1.0) * Vector3::Unit(axis);
  Quaternion upwards = Quaternion::Identity();
  if (axis == 2 && face < 0) upwards = Quaternion(0, 1, 0, 0);
  if (axis < 2) upwards = Quaternion::FromTwoVectors(Vector3::UnitZ(), outwards);
  const Pose own{half * outwards, upwards};
  return {HalfSpace{}, shape.place * own};
}

std::vector<ContactPoint> contact_points(const ContactShape& shape, double spacing) {
  std::vector<ContactPoint> out = std::visit([&](const auto& each) { return points_of(each, spacing); }, shape.kind);
  const Matrix3 axes = shape.place.orientation.toRotationMatrix();
  for (ContactPoint& point : out) {
    point.arm = shape.place * point.arm;
    point.outwards = axes * point.outwards;
  }
  return out;
}

}  // namespace flexarm
