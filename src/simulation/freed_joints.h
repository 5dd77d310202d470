#pragma once
/// Held joints for those who ask what would be if they moved.

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// The same mechanism in the same motion, in which held joints have nodes and coordinates that motions drive. Its
/// velocities are those that are published.
Simulation with_joints_freed(const Simulation& held);

}  // namespace flexarm
