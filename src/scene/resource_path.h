#pragma once
/// Files that a scene names.

#include <string>

namespace flexarm::scene {

/// Where a file lies: the path of file://PATH; a path, from the folder of the scene's file on; or of
/// package://PACKAGE/PATH: of a package in ROS_PACKAGE_PATH, else of a folder of that name that the scene's file is in
/// or beside.
/// @throws std::runtime_error saying what was looked for where
std::string path_of_resource(const std::string& url, const std::string& scene_file);

}  // namespace flexarm::scene
