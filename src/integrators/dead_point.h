#pragma once
/// Finds dead points: configurations in which the constraints of a loop block each other.

#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Index of a closure that is at a dead point in the configuration of `state`. At a dead point, constraints that are
/// independent in the initial configuration become dependent with respect to the free coordinates. Or they nearly do: a
/// joint of the loop would have to move a hundred times faster than others. -1 if there is none. Slow; allocates
/// memory.
int closure_at_dead_point(const Model& model, const DegreesOfFreedom& dof, const State& state);

}  // namespace flexarm
