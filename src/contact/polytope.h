#pragma once
/// A convex body bounded by planes.

#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

struct Polytope {
  struct Face {
    Vector3 normal;            ///< outwards, unit
    double offset;             ///< normal . x on it [m]
    std::vector<int> corners;  ///< round it, counterclockwise as seen from outside
  };
  std::vector<Vector3> corners;  ///< [m]
  std::vector<Face> faces;
};

/// Signed distance of a point from a face's plane [m].
inline double height_over(const Polytope::Face& face, const Vector3& point) {
  return face.normal.dot(point) - face.offset;
}
/// Whether a point lies above or below a face, not beside it by more than `slack` [m].
bool is_over(const Polytope& polytope, const Polytope::Face& face, const Vector3& point, double slack);

/// Of the surface: the point nearest to one outside, and what it lies on.
struct NearestPoint {
  Vector3 position;
  /// 2, 1 or 0 of faces, edges and corners: ways along which the nearest point goes with the outer one.
  int dimensions;
  Vector3 along;  ///< of an edge: its unit direction
};
NearestPoint nearest_point(const Polytope& polytope, const Vector3& outside);

/// Half of how thick it is: of the corners' middle, how far inside it is [m].
double inner_radius(const Polytope& polytope);

}  // namespace flexarm
