#pragma once
/// Springs between points (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// Adds the scene's springs, each with a closure that has no constraints: nothing may ask of closures any more which of
/// them hold.
/// @throws ModelError for a spring whose ends are on one rigid body.
void place_springs(const ScenePlan& plan, Model& model);

}  // namespace flexarm
