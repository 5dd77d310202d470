#pragma once
/// Sensors (internal to building/).

#include <string>
#include <vector>

#include "building/scene_plan.h"
#include "model/model.h"

namespace flexarm {

/// True if a sensor of the scene measures what carries this link.
bool measures_reaction(const scene::SceneDescription& scene, const std::string& link);

/// Sets the model's sensors and reactions. `slave_joint`: per node, the joint of which it is the slave, or -1.
/// @throws ModelError for a sensor that does not go with its link.
void place_sensors(const ScenePlan& plan, const std::vector<int>& slave_joint, Model& model);

}  // namespace flexarm
