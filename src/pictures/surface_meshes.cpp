#include "pictures/surface_meshes.h"

#include <filesystem>
#include <stdexcept>

#include "flexarm/scene/resource_path.h"
#include "math/loaded_library.h"
#include "meshes/library.h"

namespace flexarm::pictures {

SurfaceMesh surface_of_mesh(const scene::MeshShape& mesh, const std::string& scene_file) {
  const std::string path = scene::path_of_resource(mesh.url, scene_file);
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("there is no file " + path);
  return loaded_functions<meshes::Library>(meshes::kLibrary, meshes::kSymbol, "meshes cannot be read")
      .surface_of_file(path, mesh.scale);
}

}  // namespace flexarm::pictures
