#include "flexarm/scene/resource_path.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace flexarm::scene {
namespace {

namespace fs = std::filesystem;

/// How many levels below a folder of ROS_PACKAGE_PATH packages are searched.
constexpr int kMostLevels = 4;

/// Searches for a folder of that name with a package.xml. Like rospack, does not search inside packages and hidden
/// folders.
std::optional<fs::path> package_below(const fs::path& folder, const std::string& package, int levels) {
  std::error_code ignored;
  if (fs::exists(folder / "package.xml", ignored))
    return folder.filename() == package ? std::optional(folder) : std::nullopt;
  if (fs::exists(folder / package / "package.xml", ignored)) return folder / package;
  if (levels == 0 || fs::exists(folder / "CATKIN_IGNORE", ignored)) return std::nullopt;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_directory(ignored) && entry.path().filename().string().front() != '.')
      if (auto found = package_below(entry.path(), package, levels - 1)) return found;
  return std::nullopt;
}

std::optional<fs::path> package_folder(const std::string& package, const fs::path& folder) {
  const char* const paths = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream list(paths ? paths : "");
  for (std::string path; std::getline(list, path, ':');)
    if (!path.empty())
      if (auto found = package_below(path, package, kMostLevels)) return found;
  // ROS may not know the package. The scene's file usually lies in the same package as its meshes, so search upwards.
  std::error_code ignored;
  for (fs::path above = fs::current_path(ignored) / folder;; above = above.parent_path()) {
    if (above.filename() == package) return above;
    if (fs::is_directory(above / package, ignored)) return above / package;
    if (above == above.parent_path()) break;
  }
  return std::nullopt;
}

std::string after(const std::string& url, const char* scheme) {
  return url.substr(std::string(scheme).size());
}

bool begins_with(const std::string& url, const char* scheme) {
  return url.rfind(scheme, 0) == 0;
}

}  // namespace

std::string path_of_resource(const std::string& url, const std::string& scene_file) {
  const fs::path folder = fs::path(scene_file).parent_path();
  if (begins_with(url, "file://")) return after(url, "file://");
  if (begins_with(url, "package://")) {
    const std::string path = after(url, "package://");
    const std::string package = path.substr(0, path.find('/'));
    const auto found = package_folder(package, folder);
    if (!found)
      throw std::runtime_error("package '" + package + "' is neither in ROS_PACKAGE_PATH nor beside the scene's file");
    return found->parent_path() / path;
  }
  if (url.find("://") != std::string::npos)
    throw std::runtime_error("expected package://PACKAGE/PATH, file://PATH or a path");
  return folder / url;
}

}  // namespace flexarm::scene
