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

/// Coordinates that can move together against an inertia that is hidden by round-off of their own inertias: their
/// accelerations would have no digits. An example is an axis that a rounded angle (1.5708) puts beside another one.
/// Empty if there is no such motion, for mechanisms with loops, and for more than 100 coordinates. Beams count as
/// rigid.
std::vector<int> coordinates_of_hidden_inertia(const Model& model);

}  // namespace flexarm
