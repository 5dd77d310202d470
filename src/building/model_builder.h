#pragma once
/// From a scene description to a model.

#include <optional>
#include <vector>

#include "building/rigid_lines.h"
#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Meshes the flexible links, turns joints into elementary maps, lumps rigid bodies on nodes and places loads.
/// `rigid_lines`: where the lines of links with rigid beams are wanted, per link; null: nowhere.
/// @throws ModelError
Model build_model(const scene::SceneDescription& scene, std::vector<std::optional<RigidLine>>* rigid_lines = nullptr);

}  // namespace flexarm
