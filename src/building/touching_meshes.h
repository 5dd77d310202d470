#pragma once
/// Meshes of <collision> elements, for contacts.

#include <memory>
#include <string>
#include <vector>

#include "contact/polytope.h"
#include "flexarm/scene/visual_description.h"

namespace flexarm {

/// The convex hulls of a mesh, see meshes::hulls_of_file(). A file is read once, as long as it does not change.
/// `scene_file`: see scene::path_of_resource().
/// @throws std::runtime_error that says why, if it is not found or cannot be read
using Polytopes = std::vector<std::shared_ptr<const Polytope>>;
Polytopes hulls_of_mesh(const scene::MeshShape& mesh, const std::string& scene_file);

}  // namespace flexarm
