#pragma once
/// Convex bodies, built by hand for tests.

#include "contact/polytope.h"

namespace flexarm::test {

/// Returns a body with these corners and faces. The corners of a face are counterclockwise as seen from outside.
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

/// Returns a box. The bits of a corner's index tell its signs: 1 for +x, 2 for +y, 4 for +z.
inline Polytope box_polytope(const Vector3& half) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back(half.cwiseProduct(Vector3(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0)));
  return polytope_of(std::move(corners),
                     {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}});
}

/// Returns a body with a flat roof, whose ridge is along y. Its two slopes start at the height half.z() and rise by
/// `rise` over half.x(), above a box.
inline Polytope roof_polytope(const Vector3& half, double rise) {
  std::vector<Vector3> corners = box_polytope(half).corners;
  corners.emplace_back(0, -half.y(), half.z() + rise);
  corners.emplace_back(0, half.y(), half.z() + rise);
  return polytope_of(
      std::move(corners),
      {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 9, 7, 3}, {0, 1, 5, 8, 4}, {5, 7, 9, 8}, {4, 8, 9, 6}, {0, 2, 3, 1}});
}

}  // namespace flexarm::test
