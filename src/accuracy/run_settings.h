#pragma once
/// The settings of a scene that are chosen for an accuracy: meshes of beams, scheme, step, Newton's tolerance.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// How finely a beam is divided.
struct BeamResolution {
  std::optional<int> elements;  ///< empty: "auto"; 0: the link is rigid
  int order = 2;

  /// Elements x order: "3 x 2", "auto x 2", or "rigid".
  std::string text() const;
  bool operator<(const BeamResolution& other) const;
  bool operator==(const BeamResolution& other) const;
};

struct RunSettings {
  std::vector<BeamResolution> beams;  ///< of the links with beams, in the scene's order
  std::string scheme;
  double step = 0;       ///< [s]
  double tolerance = 0;  ///< of Newton's method

  std::string mesh() const;  ///< "3 x 2, rigid"; "–" without beams
  bool operator<(const RunSettings& other) const;
};

RunSettings settings_of(const scene::SceneDescription& scene);
/// The scene with these settings. Removes options of <integrator> that the scheme does not take.
/// @throws std::invalid_argument unless there is one resolution for each beam.
scene::SceneDescription with_settings(scene::SceneDescription scene, const RunSettings& settings);

}  // namespace flexarm
