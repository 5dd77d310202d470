#pragma once
/// Reads mesh files as convex bodies.

#include <string>
#include <vector>

#include "contact/polytope.h"

namespace Assimp {
class Importer;
}

namespace flexarm::meshes {

/// The largest number of corners of a hull. Each corner is a contact point.
constexpr std::size_t kMostCorners = 64;

/// Lets Collada files keep the axes that they are written in, as URDF means it and rviz does. Otherwise Assimp turns
/// those with `<up_axis>Z_UP</up_axis>` so that y is up.
void keep_axes(Assimp::Importer& importer);

/// @throws std::runtime_error that says so if Git LFS has not fetched the file yet.
void refuse_lfs_pointer(const std::string& path);

/// Returns the convex hull of each mesh in a file that Assimp can read (STL, OBJ, Collada, ...), scaled, in the file's
/// frame. Hulls with more than kMostCorners corners are simplified, see simple_hull(). Flat meshes are left out.
/// @throws std::runtime_error if the file cannot be read, or no mesh in it has a volume
std::vector<Polytope> hulls_of_file(const std::string& path, const Vector3& scale);

}  // namespace flexarm::meshes
