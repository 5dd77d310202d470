#pragma once
/// Finds joints whose drives act on the end of a beam, where the beam's own inertia is too small to resist them.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// The inertia that resists the drive of a rotary joint.
struct DrivenEnd {
  std::string coordinate;
  double within_step;    ///< effective inertia within one step, in which the beam can deform [kg m^2]
  double whole;          ///< inertia of everything that the joint moves [kg m^2]
  double shakes_beyond;  ///< damping gain of an external controller that acts once a step [N m s/rad]
};

/// Driven rotary joints whose inertia within a step is less than a hundredth of the inertia that the joint moves. This
/// happens because the end of a flexible link has no inertia of its own. Simulations are accurate all the same. But an
/// external controller that acts once a step can shake such a joint: if its damping gain exceeds 2 `within_step` /
/// step, or even with a smaller gain if the beam has little damping. Driven are joints that have an effort, a servo or
/// a drive in the scene, and joints at a beam whose effort the scene limits, as commands may drive them. Returns
/// nothing for large models (more than 500 unknowns).
std::vector<DrivenEnd> driven_ends(const Simulation& simulation);

/// A warning about servos of the scene that shake such joints because their samples are too far apart. The warning says
/// which <drive> elements would help. Empty if there are none.
std::string warning_of_shaking_servos(const Simulation& simulation);

}  // namespace flexarm
