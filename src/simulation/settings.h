#pragma once
/// Makes the settings of a simulation from <integrator> and from its options.

#include <string>

#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/step_settings.h"
#include "schemes/scheme.h"

namespace flexarm {

/// The prefix "file:line: " with the place of <integrator>, or with the file alone if the scene has no such element.
std::string integrator_place(const scene::SceneDescription& scene);

/// Returns the result of `make`. If that throws a ModelError, the error gets the place of <integrator>.
template <class Make>
auto made_for_integrator(const scene::SceneDescription& scene, const Make& make) {
  try {
    return make();
  } catch (const ModelError& error) {
    throw ModelError(integrator_place(scene) + error.what());
  }
}

/// @throws ModelError that names the first setting that is out of range.
StepSettings settings_of(const scene::SceneDescription& scene, const SimulationOptions& options);

/// The scene with the scheme and the step in use.
/// @throws ModelError as settings_of().
scene::SceneDescription with_options(scene::SceneDescription scene, const SimulationOptions& options);

/// @throws ModelError that names the first slide that does not suit the scheme.
void require_suitable_slides(const scene::SceneDescription& scene, const Scheme& scheme);

}  // namespace flexarm
