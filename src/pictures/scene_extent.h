#pragma once
/// Finds where the scene lies and how far it can reach, for displays.

#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::pictures {

struct SceneExtent {
  Vector3 center;  ///< in the world [m]
  double radius;   ///< of a sphere around everything [m]; 1 for a scene without any extent
};

/// A sphere around all places that the scene can reach, from the present configuration and by its joints. A link that
/// turns reaches as far as it is long, and a link that slides as far as its limits. Link frames, centres of mass and
/// centrelines count; shapes for display do not. Floating bodies count at their present places, beams with their
/// present length and bending.
/// @param more_points  points of each link that count as well, in the link's frame, if there are any [m]
SceneExtent scene_extent(const Simulation& simulation, const std::vector<std::vector<Vector3>>& more_points = {});

}  // namespace flexarm::pictures
