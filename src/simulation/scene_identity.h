#pragma once
/// What two scenes must have in common so that a state of one fits the other.

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"

namespace flexarm {

/// A value of a scene with its name: "link 'arm' beam section young", "7e+10".
struct SceneValue {
  std::string name, value;
};

struct SceneIdentity {
  /// One line for each part of the scene: the integrator and the step by their numbers, all other parts by name and
  /// fingerprint. It does not contain what changes no motion (probes, places in the file), nor what only limits
  /// Newton's method (tolerance, iterations, halvings), so that a run that failed may be resumed with other limits.
  std::string text;
  /// The scene's parameters and then the values behind the fingerprints. Messages use them to say what differs.
  std::vector<SceneValue> values;
};

/// `scheme`: the scheme in use.
SceneIdentity identity_of(const scene::SceneDescription& scene, const Scheme& scheme);
/// Returns the text only, for the scheme that the scene chooses.
/// @throws ModelError if the integrator's options contradict each other.
std::string scene_identity(const scene::SceneDescription& scene);

}  // namespace flexarm
