#include "contact/polytope.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace flexarm {
namespace {

/// Calls visit(corner, next corner) around a face, until it returns false. Returns whether it never did.
template <class Visit>
bool all_sides(const Polytope& polytope, const Polytope::Face& face, const Visit& visit) {
  for (std::size_t i = 0; i < face.corners.size(); ++i)
    if (!visit(polytope.corners[face.corners[i]], polytope.corners[face.corners[(i + 1) % face.corners.size()]]))
      return false;
  return true;
}

NearestPoint nearest_on_side(const Vector3& begin, const Vector3& end, const Vector3& point) {
  const Vector3 side = end - begin;
  const double length = side.norm(), way = (point - begin).dot(side) / length;
  if (way <= 0) return {begin, 0, Vector3::Zero()};
  if (way >= length) return {end, 0, Vector3::Zero()};
  return {begin + way / length * side, 1, side / length};
}

}  // namespace

bool is_over(const Polytope& polytope, const Polytope::Face& face, const Vector3& point, double slack) {
  return all_sides(polytope, face, [&](const Vector3& begin, const Vector3& end) {
    return (end - begin).cross(face.normal).normalized().dot(point - begin) <= slack;
  });
}

NearestPoint nearest_point(const Polytope& polytope, const Vector3& outside) {
  NearestPoint nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (const Polytope::Face& face : polytope.faces) {
    const double height = height_over(face, outside);
    if (height <= 0) continue;  // the face is turned away from the point
    if (is_over(polytope, face, outside, 0)) return {outside - height * face.normal, 2, Vector3::Zero()};
    all_sides(polytope, face, [&](const Vector3& begin, const Vector3& end) {
      const NearestPoint each = nearest_on_side(begin, end, outside);
      const double distance = (outside - each.position).norm();
      if (distance < least) nearest = each, least = distance;
      return true;
    });
  }
  return nearest;
}

double inner_radius(const Polytope& polytope) {
  const Vector3 sum = std::accumulate(polytope.corners.begin(), polytope.corners.end(), Vector3(Vector3::Zero()));
  const Vector3 middle = sum / static_cast<double>(polytope.corners.size());
  double least = std::numeric_limits<double>::infinity();
  for (const Polytope::Face& face : polytope.faces) least = std::min(least, -height_over(face, middle));
  return least;
}

}  // namespace flexarm
