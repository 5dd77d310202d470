#pragma once
/// The interface of the library that reads mesh files, as convex bodies for contact and as surfaces for display. It is
/// loaded when it is first needed, since loading Assimp takes longer than many simulations.

#include <string>
#include <vector>

#include "contact/polytope.h"
#include "meshes/surface_mesh.h"

namespace flexarm::meshes {

/// The functions of the library.
struct Library {
  /// See hulls_of_file().
  std::vector<Polytope> (*hulls_of_file)(const std::string& path, const Vector3& scale);
  /// See surface_of_file().
  SurfaceMesh (*surface_of_file)(const std::string& path, const Vector3& scale);
};

constexpr const char* kLibrary = "libflexarm_meshes.so";
/// The name of the library's only symbol: a `const Library`.
constexpr const char* kSymbol = "flexarm_mesh_library";

}  // namespace flexarm::meshes
