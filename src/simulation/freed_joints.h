#pragma once
/// Frees held joints, for analyses that need their motion. A held joint has a constant position, so that the model has
/// no node or unknown for it.

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Makes a simulation of the same mechanism in the same motion, in which held joints have nodes, and coordinates that
/// motions prescribe. Its velocities are the published ones.
Simulation with_joints_freed(const Simulation& held);

}  // namespace flexarm
