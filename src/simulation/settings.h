#pragma once
/// The settings that follow from <integrator> and the options of a simulation.

#include <string>

#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/step_settings.h"
#include "schemes/scheme.h"

namespace flexarm {

/// "file:line: ", of <integrator>, or of the file where it has none.
std::string integrator_place(const scene::SceneDescription& scene);

/// What `make` returns; what it finds wrong with <integrator> says where that is.
template <class Make>
auto made_for_integrator(const scene::SceneDescription& scene, const Make& make) {
  try {
    return make();
  } catch (const ModelError& error) {
    throw ModelError(integrator_place(scene) + error.what());
  }
}

/// @throws ModelError naming the first setting that is out of range.
StepSettings settings_of(const scene::SceneDescription& scene, const SimulationOptions& options);

/// The scene with the scheme and the step in use.
/// @throws ModelError as settings_of().
scene::SceneDescription with_options(scene::SceneDescription scene, const SimulationOptions& options);

/// @throws ModelError naming the first slide that does not go with the scheme.
void require_suitable_slides(const scene::SceneDescription& scene, const Scheme& scheme);

}  // namespace flexarm
