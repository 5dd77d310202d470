#pragma once
/// Joints whose drives act where a beam ends, and gives way.

#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// What resists the drive of a joint that turns.
struct DrivenEnd {
  std::string coordinate;
  double within_step;  ///< within one step, in which the beam gives way [kg m^2]
  double whole;        ///< of all that the joint moves [kg m^2]
};

/// Driven joints of which hardly a hundredth resists within a step, as a flexible link has no inertia of its own where
/// it begins. Their motion as a whole does not suffer: a controller outside does that acts once a step. Where it damps
/// by more than twice `within_step` over the step's length, it shakes the joint; where the beam is hardly damped
/// itself, by less. None of models that are large.
std::vector<DrivenEnd> driven_ends(const Simulation& simulation);

/// Servos of the scene that suffer from it, as their samples are far apart: what to write where. Empty: none does.
std::string warning_of_shaking_servos(const Simulation& simulation);

}  // namespace flexarm
