#pragma once
/// Computes convex hulls of points.

#include <stdexcept>
#include <vector>

#include "contact/polytope.h"

namespace flexarm::meshes {

/// The error for points that lie in a plane, or are fewer than four.
struct FlatPoints : std::runtime_error {
  FlatPoints() : std::runtime_error("its points lie in a plane, or too close to one") {}
};

/// Returns the convex hull of points [m]. Faces that are in one plane, up to a millionth of the size, are merged.
/// @throws FlatPoints
Polytope convex_hull(const std::vector<Vector3>& points);

/// Returns the convex hull. If it has more than `most_corners` corners, at most max(most_corners, 10) of them are used.
/// These are chosen one by one: each is the corner that is farthest outside of the hull of those chosen before. The
/// result lies inside the convex hull.
/// @throws FlatPoints
Polytope simple_hull(const std::vector<Vector3>& points, std::size_t most_corners);

}  // namespace flexarm::meshes
