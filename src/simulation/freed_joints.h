#pragma once
/// Frees held joints for analyses that need their motion.

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// The same mechanism in the same motion, in which held joints have nodes and coordinates that motions drive. Its
/// velocities are those that are published.
Simulation with_joints_freed(const Simulation& held);

}  // namespace flexarm
