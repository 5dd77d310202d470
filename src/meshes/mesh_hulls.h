#pragma once
/// Files of meshes as convex bodies.

#include <string>
#include <vector>

#include "contact/polytope.h"

namespace flexarm::meshes {

/// Most corners of a hull. Each is a point that touches.
constexpr std::size_t kMostCorners = 64;

/// The convex hull of each mesh of a file that Assimp knows (STL, OBJ, Collada, ...), scaled, in the axes of the file;
/// see simple_hull() for those with more than kMostCorners corners.
/// Flat meshes are left out.
/// @throws std::runtime_error saying why, if the file cannot be read, or nothing in it has a volume
std::vector<Polytope> hulls_of_file(const std::string& path, const Vector3& scale);

}  // namespace flexarm::meshes
