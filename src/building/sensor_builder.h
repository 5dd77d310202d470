#pragma once
/// Sensors (internal to building/).

#include <string>
#include <vector>

#include "building/mechanism.h"

namespace flexarm {

/// True if a sensor of the scene measures what carries this link.
bool measures_reaction(const scene::SceneDescription& scene, const std::string& link);

/// Sets the model's sensors and reactions; the mechanism is that of the model.
/// @throws ModelError for a sensor that does not go with its link.
void place_sensors(const ScenePlan& plan, const Mechanism& mechanism, Model& model);

}  // namespace flexarm
