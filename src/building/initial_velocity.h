#pragma once
/// The velocity field at the start (internal to building/).

#include <vector>

#include "building/mechanism.h"

namespace flexarm {

/// Per node {v, w}, spatial, from joint rates and links' rigid velocity fields [m/s, rad/s]. Root to leaf: every link
/// moves rigidly with its joint, unless the scene gives it a field of its own. Then the joints that close loops take
/// the nodes that they hold along; what that changes is a rate of deformation of their beams.
/// @throws ModelError where a rigid link's joints do not allow its field, or a loop of rigid links the joints' rates.
std::vector<Vector6> initial_velocity(const ScenePlan& plan, const SolvableMechanism& mechanism);

}  // namespace flexarm
