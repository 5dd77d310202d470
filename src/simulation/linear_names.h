#pragma once
/// Names and rates of the coordinates of linear models.

#include <string>
#include <vector>

#include "analysis/linear_dynamics.h"
#include "analysis/mechanism_states.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Names of scalars of DegreesOfFreedom ({displacement, spin} of nodes, and joint coordinates), then of rotors of
/// actuators.
std::vector<std::string> coordinate_names(const Model& model, const DegreesOfFreedom& dof,
                                          const std::vector<int>& scalars, const std::vector<int>& rotors);

/// The published velocities of all nodes, joint coordinates and rotors.
KnownRates published_rates(const Simulation& simulation);
/// The present pose and rotor angles, with these rates.
MechanismMotion motion_of(const Simulation& simulation);

}  // namespace flexarm
