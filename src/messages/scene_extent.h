#pragma once
/// Where the scene lies, and how large it is: for displays.

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

struct SceneExtent {
  Vector3 center;  ///< in the world [m]
  double radius;   ///< of a sphere around all of it [m]; 1 for a scene without any extent
};

/// Extent of the present configuration: link frames, centres of mass, centrelines. Shapes for display do not count.
SceneExtent scene_extent(const Simulation& simulation);

}  // namespace flexarm::messages
