#include "building/touching_meshes.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <dlfcn.h>

#include "meshes/library.h"
#include "scene/resource_path.h"

namespace flexarm {
namespace {

namespace fs = std::filesystem;

const meshes::Library& mesh_library() {
  // It stays loaded: what it made has its code.
  void* const library = dlopen(meshes::kLibrary, RTLD_LAZY | RTLD_LOCAL);
  const void* const functions = library ? dlsym(library, meshes::kSymbol) : nullptr;
  if (!functions) throw std::runtime_error(std::string("meshes cannot be read: ") + dlerror());
  return *static_cast<const meshes::Library*>(functions);
}

}  // namespace

Polytopes hulls_of_mesh(const scene::MeshShape& mesh, const std::string& scene_file) {
  const std::string path = scene::path_of_resource(mesh.url, scene_file);
  if (!fs::is_regular_file(path)) throw std::runtime_error("there is no file " + path);
  using Key = std::tuple<std::string, fs::file_time_type, double, double, double>;
  static std::map<Key, Polytopes> known;
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const auto [place, is_new] =
      known.try_emplace(Key(path, fs::last_write_time(path), mesh.scale.x(), mesh.scale.y(), mesh.scale.z()));
  if (!is_new) return place->second;
  try {
    for (Polytope& hull : mesh_library().hulls_of_file(path, mesh.scale))
      place->second.push_back(std::make_shared<const Polytope>(std::move(hull)));
  } catch (...) {
    known.erase(place);
    throw;
  }
  return place->second;
}

}  // namespace flexarm
