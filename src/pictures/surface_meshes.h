#pragma once
/// Meshes of <visual> elements, for display.

#include <string>

#include "flexarm/scene/visual_description.h"
#include "meshes/surface_mesh.h"

namespace flexarm::pictures {

using SurfaceMesh = meshes::SurfaceMesh;

/// The surface of a mesh, see meshes::surface_of_file(). `scene_file`: see scene::path_of_resource().
/// @throws std::runtime_error that says why, if it is not found or cannot be read
SurfaceMesh surface_of_mesh(const scene::MeshShape& mesh, const std::string& scene_file);

}  // namespace flexarm::pictures
