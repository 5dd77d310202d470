#pragma once
/// A convex polyhedron.

#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

struct Polytope {
  struct Face {
    Vector3 normal;            ///< unit vector, outwards
    double offset;             ///< normal . x for points x on the face [m]
    std::vector<int> corners;  ///< indices around the face, counterclockwise as seen from outside
  };
  std::vector<Vector3> corners;  ///< [m]
  std::vector<Face> faces;
};

/// Returns the signed distance of a point from a face's plane, > 0 outside [m].
inline double height_over(const Polytope::Face& face, const Vector3& point) {
  return face.normal.dot(point) - face.offset;
}
/// Whether the projection of a point onto a face's plane lies in the face, or beside it by at most `slack` [m].
bool is_over(const Polytope& polytope, const Polytope::Face& face, const Vector3& point, double slack);

/// The point of the surface that is nearest to a point outside, and whether it is on a face, an edge or a corner.
struct NearestPoint {
  Vector3 position;
  /// 2: on a face, 1: on an edge, 0: a corner. This is the number of directions in which the nearest point can move.
  int dimensions;
  Vector3 along;  ///< on an edge: its unit direction; else zero
};
NearestPoint nearest_point(const Polytope& polytope, const Vector3& outside);

/// Returns about half of the polytope's thickness: the distance of the corners' mean from the nearest face [m].
double inner_radius(const Polytope& polytope);

}  // namespace flexarm
