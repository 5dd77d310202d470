#pragma once
/// Dampers of joints that a scene gives by their ratio (internal to building/).

#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Gives springs and elastic gears with a damping ratio the damper 2 ratio sqrt(k J), J: see articulated_inertias().
/// After mass properties and actuators. @throws ModelError where J is not known.
void set_damping_ratios(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model);

}  // namespace flexarm
