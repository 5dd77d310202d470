#pragma once
/// Meshes that touch, as convex bodies. The library that reads them is loaded when it is needed first, since loading
/// Assimp takes longer than many simulations.

#include <string>
#include <vector>

#include "contact/polytope.h"

namespace flexarm::meshes {

struct Library {
  /// See hulls_of_file().
  std::vector<Polytope> (*hulls_of_file)(const std::string& path, const Vector3& scale);
};

constexpr const char* kLibrary = "libflexarm_meshes.so";
/// The one symbol that is looked for there: a `const Library`.
constexpr const char* kSymbol = "flexarm_mesh_library";

}  // namespace flexarm::meshes
