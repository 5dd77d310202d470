#pragma once
/// What two scenes must have in common so that a state of one is a state of the other.

#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"

namespace flexarm {

/// One value of a scene, by what it is called: "link 'arm' beam section young", "7e+10".
struct SceneValue {
  std::string name, value;
};

struct SceneIdentity {
  /// Lines, one for each part of the scene: the integrator and the step by their numbers, all else by its name and a
  /// fingerprint of all that it says. Left out is what changes no motion (probes, where things stand in the file), and
  /// what only limits Newton's method (tolerance, iterations, halvings): a run that failed may be resumed with others.
  std::string text;
  /// What the fingerprints are made of, and before it the scene's parameters: to tell what differs.
  std::vector<SceneValue> values;
};

/// `scheme`: in use.
SceneIdentity identity_of(const scene::SceneDescription& scene, const Scheme& scheme);
/// The text of the same by the scheme that the scene asks for.
/// @throws ModelError if the integrator's options contradict each other.
std::string scene_identity(const scene::SceneDescription& scene);

}  // namespace flexarm
