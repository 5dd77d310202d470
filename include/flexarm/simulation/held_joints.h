#pragma once
/// What massless="lock" did to a scene.

#include "flexarm/scene/diagnostic.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// A warning for each joint coordinate that is held where it starts because it moves nothing that has inertia, in the
/// scene's order. Only the model knows which these are.
scene::Diagnostics held_joints(const Simulation& simulation);

}  // namespace flexarm
