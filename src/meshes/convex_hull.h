#pragma once
/// The convex hull of points.

#include <stdexcept>
#include <vector>

#include "contact/polytope.h"

namespace flexarm::meshes {

/// Points that lie in a plane, or are fewer than four.
struct FlatPoints : std::runtime_error {
  FlatPoints() : std::runtime_error("its points lie in a plane, or too close to one") {}
};

/// The least convex body that holds all points [m]. Faces that are one plane but for a millionth of its size are one.
/// @throws FlatPoints
Polytope convex_hull(const std::vector<Vector3>& points);

/// The same, but with not more than so many of the corners, if it can be had with them: chosen one after the other,
/// each where the body that there is lacks most. It lies inside of the hull.
Polytope simple_hull(const std::vector<Vector3>& points, std::size_t most_corners);

}  // namespace flexarm::meshes
