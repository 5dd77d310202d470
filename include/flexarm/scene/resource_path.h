#pragma once
/// Finds files that a scene names, such as meshes.

#include <string>

namespace flexarm::scene {

/// Returns the path of a file that is given as file://PATH, package://PACKAGE/PATH, or a path relative to the folder of
/// the scene's file. A package is searched in ROS_PACKAGE_PATH. If it is not there, a folder of its name is searched in
/// all folders above the scene's file.
/// @throws std::runtime_error if there is no such package, or the URL has another scheme
std::string path_of_resource(const std::string& url, const std::string& scene_file);

}  // namespace flexarm::scene
