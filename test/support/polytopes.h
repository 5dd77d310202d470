#pragma once
/// Convex bodies made by hand.

#include "contact/polytope.h"

namespace flexarm::test {

/// A body from its corners and the corners of its faces, counterclockwise as seen from outside.
inline Polytope polytope_of(std::vector<Vector3> corners, std::vector<std::vector<int>> faces) {
  Polytope out;
  for (std::vector<int>& face : faces) {
    const Vector3 &a = corners[face[0]], &b = corners[face[1]], &c = corners[face[2]];
    const Vector3 normal = (b - a).cross(c - b).normalized();
    out.faces.push_back({normal, normal.dot(a), std::move(face)});
  }
  out.corners = std::move(corners);
  return out;
}

/// Corners as the bits of their numbers say: 1 of +x, 2 of +y, 4 of +z.
inline Polytope box_polytope(const Vector3& half) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(half.cwiseProduct(Vector3(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0)));
  return polytope_of(std::move(corners),
                     {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}});
}

/// A flat roof along y: two slopes that rise by `rise` over `half.x()` from the height half.z() on, above a box.
inline Polytope roof_polytope(const Vector3& half, double rise) {
  std::vector<Vector3> corners = box_polytope(half).corners;
  corners.emplace_back(0, -half.y(), half.z() + rise);
  corners.emplace_back(0, half.y(), half.z() + rise);
  return polytope_of(
      std::move(corners),
      {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 9, 7, 3}, {0, 1, 5, 8, 4}, {5, 7, 9, 8}, {4, 8, 9, 6}, {0, 2, 3, 1}});
}

}  // namespace flexarm::test
