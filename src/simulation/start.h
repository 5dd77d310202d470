#pragma once
/// The start of a simulation: its equilibrium, and warnings about the start.

#include <set>
#include <string>

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Names of the coordinates of hidden joints. A Model has these behind all others.
std::set<std::string> hidden_coordinates(const scene::SceneDescription& scene);

/// A warning for each joint coordinate that massless="lock" holds where it starts, in the scene's order.
scene::Diagnostics held_joints(const scene::SceneDescription& scene, const Model& model);

/// A warning if joints together move nearly nothing that has inertia: see coordinates_of_hidden_inertia().
scene::Diagnostics hidden_inertia(const scene::SceneDescription& scene, const Model& model);

/// A warning if the scheme does not damp the oscillation of its accelerations across joints. (docs/notes/joints.md 3.2)
scene::Diagnostics doubts_about_scheme(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme);

/// A warning for each pair that overlaps so much at the start that the contact pushes it apart only slowly.
scene::Diagnostics overlaps(const scene::SceneDescription& scene, const Model& model, const State& state);

/// A warning that the motion begins with accelerations of zero, since the right ones cannot be found. `failure`: the
/// reason, in words.
scene::Diagnostic unknown_accelerations(const scene::SceneDescription& scene, const std::string& failure);

/// Brings `state` to the equilibrium of the scene, at rest. Adds doubts about the equilibrium to `warnings`.
/// @throws ModelError if there is no equilibrium (it names joints that nothing holds), or if the scene gives a
/// velocity.
void start_in_equilibrium(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme,
                          const StepSettings& settings, State& state, scene::Diagnostics& warnings);

}  // namespace flexarm
