#pragma once
/// How a simulation starts.

#include <string>

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// A warning for each joint coordinate that massless="lock" holds where it starts, in the scene's order.
scene::Diagnostics held_joints(const scene::SceneDescription& scene, const Model& model);

/// A warning where the scheme does not damp what its accelerations do across joints. (docs/notes/joints.md 3.2)
scene::Diagnostics doubts_about_scheme(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme);

/// A warning for each pair that starts so deep inside of each other that it is let out slowly.
scene::Diagnostics overlaps(const scene::SceneDescription& scene, const Model& model, const State& state);

/// A warning that a motion begins with accelerations of zero, since its own cannot be found. `failure`: why, in words.
scene::Diagnostic unknown_accelerations(const scene::SceneDescription& scene, const std::string& failure);

/// Brings `state` to the equilibrium of the scene, at rest; adds what is doubtful about it to `warnings`.
/// @throws ModelError where there is none, naming joints that nothing holds, or where the scene gives a velocity.
void start_in_equilibrium(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme,
                          const StepSettings& settings, State& state, scene::Diagnostics& warnings);

}  // namespace flexarm
