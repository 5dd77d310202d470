#pragma once
/// Finds where the scene lies and how far it can reach, for displays.

#include <functional>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::pictures {

/// Around what a picture shows at its beginning.
struct SceneExtent {
  Vector3 center;  ///< in the world [m]
  double radius;   ///< of a sphere around everything [m]; 1 for a scene without any extent
  Vector3 half;    ///< half edges of a box around the same, with the same centre, along the world's axes [m]
};

/// A ball that a picture may have to show.
struct ExtentBall {
  Vector3 center;  ///< in the world [m]
  double radius;   ///< [m]
  bool is_fixed;   ///< nothing can move it
};
using ExtentBallVisitor = std::function<void(const ExtentBall&)>;

/// Encloses all balls that can move, and those fixed ones that are near: not farther from the centre of the others than
/// twice their radius. So neither walls nor floors make a mechanism small in the picture. If nothing can move, all
/// balls count. Balls that are not finite do not.
/// @param visit_balls  calls its argument with each ball, in each of several calls
SceneExtent extent_around(const std::function<void(const ExtentBallVisitor&)>& visit_balls);

/// Whether nothing can move or bend a link.
bool is_fixed(const Simulation& simulation, std::size_t link);

/// The extent of all places that the scene can reach, from the present configuration and by its joints. A link that
/// turns reaches as far as it is long, and a link that slides as far as its limits. Link frames, centres of mass,
/// centrelines, springs and tendons count; shapes for display do not. Floating bodies count at their present places,
/// beams with their present length and bending. Of what cannot move, only what is near counts (extent_around()).
/// @param more_points  points of each link that count as well, in the link's frame, if there are any [m]
SceneExtent scene_extent(const Simulation& simulation, const std::vector<std::vector<Vector3>>& more_points = {});

}  // namespace flexarm::pictures
