#pragma once
/// Joints that close loops (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// Adds the joints that close loops of the tree, which stands as it starts. Where it can be, the slave is a beam's node
/// that was free before (joints.md 3), else the loop gets constraints with multipliers.
/// @throws ModelError
ClosedMechanism close_loops(const ScenePlan& plan, TreeAtStart tree);

}  // namespace flexarm
