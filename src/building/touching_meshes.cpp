#include "building/touching_meshes.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "flexarm/scene/resource_path.h"
#include "math/loaded_library.h"
#include "meshes/library.h"

namespace flexarm {
namespace {

namespace fs = std::filesystem;

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
    const auto& functions =
        loaded_functions<meshes::Library>(meshes::kLibrary, meshes::kSymbol, "meshes cannot be read");
    for (Polytope& hull : functions.hulls_of_file(path, mesh.scale))
      place->second.push_back(std::make_shared<const Polytope>(std::move(hull)));
  } catch (...) {
    known.erase(place);
    throw;
  }
  return place->second;
}

}  // namespace flexarm
