#pragma once
/// What two scenes must have in common for a state of one to be a state of the other.

#include <string>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Lines of text, one for each part of the scene: the integrator and the step by their numbers, all else by its name
/// and a fingerprint of all that it says. Left out is what changes no motion (probes, where things stand in the file),
/// and what only limits Newton's method (tolerance, iterations, halvings): a run that failed may be resumed with
/// others. `scheme`: in use.
std::string scene_identity(const scene::SceneDescription& scene, const Scheme& scheme);
/// The same by the scheme that the scene asks for.
/// @throws ModelError if the integrator's options contradict each other.
std::string scene_identity(const scene::SceneDescription& scene);

}  // namespace flexarm
