#pragma once
/// Builds a model from a scene description.

#include <optional>
#include <vector>

#include "building/rigid_lines.h"
#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Meshes the flexible links, turns joints into elementary joints, lumps rigid bodies at nodes, and places loads.
/// `rigid_lines`: receives the lines of links with rigid beams, per link; may be null.
/// @throws ModelError
Model build_model(const scene::SceneDescription& scene, std::vector<std::optional<RigidLine>>* rigid_lines = nullptr);

}  // namespace flexarm
