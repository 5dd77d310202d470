#pragma once
/// Reads mesh files as surfaces, for display.

#include <array>
#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm::meshes {

/// Vertices with the normals of the surface, and triangles between them, counter-clockwise as seen from outside. Along
/// a sharp edge there are several vertices at the same place.
struct SurfaceMesh {
  struct Vertex {
    Vector3 position, normal;
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices
};

/// Reads a mesh of any format that Assimp supports (STL, OBJ, Collada, ...), scaled, in the axes of the file.
/// @throws std::runtime_error with the reason, if the file cannot be read, or has no triangles or too many
SurfaceMesh surface_of_file(const std::string& path, const Vector3& scale);

}  // namespace flexarm::meshes
