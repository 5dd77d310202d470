#pragma once
/// Mass properties that need the finished mechanism (internal to model/).

#include <vector>

#include "flexarm/model/model.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// Checks that every released coordinate moves some inertia, and gives the stops of limited coordinates their penalty.
/// `node_parents`: see MechanismBuilder.
/// @throws ModelError
void finish_mass_properties(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model);

}  // namespace flexarm
