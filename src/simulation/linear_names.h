#pragma once
/// Coordinates of linear models: their names, and how fast they are.

#include <string>
#include <vector>

#include "analysis/linear_dynamics.h"
#include "analysis/mechanism_states.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Of scalars of DegreesOfFreedom, {displacement, spin} of nodes or joint coordinates, then of the rotors of actuators.
std::vector<std::string> coordinate_names(const Model& model, const DegreesOfFreedom& dof,
                                          const std::vector<int>& scalars, const std::vector<int>& rotors);

/// Velocities for output of all nodes and joint coordinates.
KnownRates published_rates(const Simulation& simulation);
/// The same with where they are.
MechanismMotion motion_of(const Simulation& simulation);

}  // namespace flexarm
