// Faces of shapes: by which face a point enters, and on which face it can lie.
#include <algorithm>
#include <limits>

#include "contact/shape.h"

namespace flexarm {
namespace {

/// Returns a rotation that turns the z axis into `normal`.
Quaternion from_z_to(const Vector3& normal) {
  if (normal.z() < -0.5) return Quaternion(0, 1, 0, 0) * from_z_to({normal.x(), -normal.y(), -normal.z()});
  return Quaternion(1 + normal.z(), -normal.y(), normal.x(), 0).normalized();
}

/// A point counts as over a face if it is beside it by at most this, relative to the shape's size (round-off).
constexpr double kBeside = 1e-9;
/// A point that starts below a face by at most this, relative to the shape's size, may still enter by that face. If a
/// scene puts equal boxes on each other, corners are slightly below several faces.
constexpr double kFlush = 1e-3;
/// A corner can lie on a face if the cosines between the face's normal and the normals of the faces that meet in the
/// corner are all at most kAside, and at least one is at most kOpposite.
constexpr double kAside = 0.2, kOpposite = -0.5;

int face_count(const Box&) {
  return 6;
}
double height_over(const Box& box, int face, const Vector3& y) {
  const int axis = face / 2;
  return (face % 2 == 0 ? y[axis] : -y[axis]) - box.half[axis];
}
bool is_over(const Box& box, int face, const Vector3& y, double slack) {
  Vector3 beside = y.cwiseAbs() - box.half;
  beside[face / 2] = 0;
  return beside.maxCoeff() <= slack;
}
Vector3 normal_of(const Box&, int face) {
  return (face % 2 == 0 ? 1.0 : -1.0) * Vector3::Unit(face / 2);
}
Pose frame_on(const Box& box, int face) {
  const Vector3 outwards = normal_of(box, face);
  return {box.half[face / 2] * outwards, from_z_to(outwards)};
}
double size_of(const Box& box) {
  return box.half.maxCoeff();
}

int face_count(const Cylinder&) {
  return 3;
}
double height_over(const Cylinder& cylinder, int face, const Vector3& y) {
  if (face == 0) return y.head<2>().norm() - cylinder.radius;
  return (face == 1 ? y.z() : -y.z()) - cylinder.half_length;
}
bool is_over(const Cylinder& cylinder, int face, const Vector3& y, double slack) {
  if (face == 0) return std::abs(y.z()) - cylinder.half_length <= slack;
  return height_over(cylinder, 0, y) <= slack;
}
/// Not of the side.
Vector3 normal_of(const Cylinder&, int face) {
  return (face == 1 ? 1.0 : -1.0) * Vector3::UnitZ();
}
Pose frame_on(const Cylinder& cylinder, int face) {
  if (face == 1) return {{0, 0, cylinder.half_length}, Quaternion::Identity()};
  return {{0, 0, -cylinder.half_length}, Quaternion(0, 1, 0, 0)};
}
double size_of(const Cylinder& cylinder) {
  return std::max(cylinder.radius, cylinder.half_length);
}

int face_count(const Hull& hull) {
  return static_cast<int>(hull.polytope->faces.size());
}
double height_over(const Hull& hull, int face, const Vector3& y) {
  return height_over(hull.polytope->faces[face], y);
}
bool is_over(const Hull& hull, int face, const Vector3& y, double slack) {
  return is_over(*hull.polytope, hull.polytope->faces[face], y, slack);
}
Vector3 normal_of(const Hull& hull, int face) {
  return hull.polytope->faces[face].normal;
}
Pose frame_on(const Hull& hull, int face) {
  const Polytope::Face& each = hull.polytope->faces[face];
  return {each.offset * each.normal, from_z_to(each.normal)};
}
double size_of(const Hull& hull) {
  const std::vector<Vector3>& corners = hull.polytope->corners;
  double size = 0;
  for (const Vector3& corner : corners) size = std::max(size, 0.5 * (corner - corners.front()).norm());
  return size;
}

bool is_round(const ContactShape& shape, int face) {
  return std::holds_alternative<Cylinder>(shape.kind) && face == 1;
}

Vector3 own_point(const ContactShape& shape, const Vector3& point) {
  return shape.place.orientation.conjugate() * (point - shape.place.position);
}

/// Returns visit(box, cylinder or hull) for a shape with faces; `otherwise` for other shapes.
template <class Result, class Visit>
Result of_faces(const ContactShape& shape, Result otherwise, const Visit& visit) {
  if (const auto* box = std::get_if<Box>(&shape.kind)) return visit(*box);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.kind)) return visit(*cylinder);
  if (const auto* hull = std::get_if<Hull>(&shape.kind)) return visit(*hull);
  return otherwise;
}

/// The face by which a point enters, numbered from 0 (-1: it does not enter), and the part of its way at which it does.
struct Entry {
  int face;
  double part;
};
template <class Shape>
Entry entry_into(const Shape& shape, const Vector3& begin, const Vector3& end) {
  const double size = size_of(shape), slack = kBeside * size;
  Entry entry{-1, -1};  // the last face plane that the point crosses
  double lowest = 0;
  for (int k = 0; k < face_count(shape); ++k) {
    const double a = height_over(shape, k, begin);
    if (a < -kFlush * size) continue;
    const double b = height_over(shape, k, end);
    if (a > slack && b >= a) return {-1, 0};
    // If the point starts on several faces, it enters by the one below which it ends deepest.
    const double part = a > slack ? a / (a - b) : 0;
    if (part < entry.part || (part == entry.part && b >= lowest)) continue;
    entry = {k, part};
    lowest = b;
  }
  if (entry.part > 1) entry.face = -1;
  return entry;
}

}  // namespace

bool has_faces(const ContactShape& shape) {
  return !shape.is_hollow && of_faces(shape, false, [](const auto&) { return true; });
}

int entered_face(const ContactShape& shape, const Vector3& from, const Vector3& to) {
  const Vector3 begin = own_point(shape, from), end = own_point(shape, to);
  const Entry entry = of_faces(shape, Entry{-1, 0}, [&](const auto& each) { return entry_into(each, begin, end); });
  if (entry.face < 0) return 0;
  return is_over_face(shape, entry.face + 1, from + entry.part * (to - from)) ? entry.face + 1 : 0;
}

int nearest_face(const ContactShape& shape, const Vector3& point) {
  const Vector3 own = own_point(shape, point);
  return of_faces(shape, 0, [&](const auto& each) {
    int nearest = 0;
    for (int k = 1; k < face_count(each); ++k)
      if (height_over(each, k, own) > height_over(each, nearest, own)) nearest = k;
    return nearest + 1;
  });
}

bool can_lie_on(const ContactShape& shape, int face, const Matrix3& outwards) {
  if (is_round(shape, face)) return true;
  const Vector3 cosines = outwards.transpose() * face_normal(shape, face);
  return cosines.maxCoeff() <= kAside && cosines.minCoeff() <= kOpposite;
}

int face_to_lie_on(const ContactShape& shape, int crossed, const Vector3& point, const Matrix3& outwards,
                   double deepest) {
  const Vector3 own = own_point(shape, point);
  return of_faces(shape, 0, [&](const auto& each) {
    int best = 0;
    for (int face = 1; face <= face_count(each); ++face) {
      const double distance = std::abs(height_over(each, face - 1, own));
      if (face == crossed || is_round(shape, face) || distance > deepest) continue;
      if (!can_lie_on(shape, face, outwards)) continue;
      best = face;
      deepest = distance;
    }
    return best;
  });
}

bool is_over_face(const ContactShape& shape, int face, const Vector3& point) {
  const Vector3 own = own_point(shape, point);
  return of_faces(shape, false,
                  [&](const auto& each) { return is_over(each, face - 1, own, kBeside * size_of(each)); });
}

Vector3 face_normal(const ContactShape& shape, int face) {
  const Vector3 own = face == 0 ? Vector3(Vector3::UnitZ())
                                : of_faces(shape, Vector3(Vector3::UnitZ()),
                                           [&](const auto& each) { return normal_of(each, face - 1); });
  return shape.place.orientation * own;
}

bool is_flat(const ContactShape& shape) {
  return !shape.is_hollow && (std::holds_alternative<HalfSpace>(shape.kind) ||
                              std::holds_alternative<Box>(shape.kind) || std::holds_alternative<Hull>(shape.kind));
}

int face_below(const ContactShape& shape, const Rim& rim) {
  const Rim own{own_point(shape, rim.middle), shape.place.orientation.conjugate() * rim.axis, rim.radius};
  return of_faces(shape, 0, [&](const auto& each) {
    int best = 0;
    double highest = -std::numeric_limits<double>::infinity();
    for (int face = 0; face < face_count(each); ++face) {
      const Vector3 normal = normal_of(each, face);
      const double height = height_over(each, face, own.middle) + normal.dot(lowest_point(own, normal));
      if (height > highest) highest = height, best = face + 1;
    }
    return best;
  });
}

ContactShape beyond_face(const ContactShape& shape, int face) {
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.kind); cylinder && face == 1)
    return {Cylinder{cylinder->radius, std::numeric_limits<double>::infinity()}, shape.place};
  const Pose own = of_faces(shape, Pose(), [&](const auto& each) { return frame_on(each, face - 1); });
  return {HalfSpace{}, shape.place * own};
}

int points_at_a_time(const ContactShape& shape, const std::vector<ContactPoint>& points) {
  if (std::holds_alternative<Tube>(shape.kind)) return kRimPoints;
  return of_faces(shape, 1, [&](const auto& each) {
    std::ptrdiff_t most = 1;
    for (int face = 0; face < face_count(each); ++face) {
      if (is_round(shape, face + 1)) continue;
      const auto lies_on = [&](const ContactPoint& point) {
        return point.rim == 0 && point.half == 0 &&
               std::abs(height_over(each, face, own_point(shape, point.arm)) + point.radius) < kFlush * size_of(each);
      };
      most = std::max(most, std::count_if(points.begin(), points.end(), lies_on));
    }
    return static_cast<int>(most);
  });
}

}  // namespace flexarm
