#pragma once
/// What stands for links that have neither shapes nor a beam.

#include <optional>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::pictures {

/// A ball at the centre of mass.
struct MassBall {
  Vector3 at;     ///< in the link's frame [m]
  double radius;  ///< of the ball of even density with the link's mass and mean moment of inertia [m]
};

/// None for a link without mass.
std::optional<MassBall> mass_ball(const scene::LinkDescription& link);

/// The radius with which the ball is drawn: neither too small nor too large to be seen well in a scene of that radius.
double shown_radius(const MassBall& ball, double scene_radius);

/// For each link, the places of the children that it carries, in its frame [m]. Those of floating and planar joints do
/// not count, since nothing connects them.
std::vector<std::vector<Vector3>> carried_places(const Simulation& simulation);

}  // namespace flexarm::pictures
