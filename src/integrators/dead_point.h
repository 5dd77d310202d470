#pragma once
/// Dead points: loops whose constraints block each other.

#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Index of a closure that is at a dead point in the configuration of `state`: its constraints, independent at the
/// start, are no longer so with respect to what is free to move, or some joint of the loop has to turn a hundred times
/// faster than others for them. -1: none. Allocates, and takes its time.
int closure_at_dead_point(const Model& model, const DegreesOfFreedom& dof, const State& state);

}  // namespace flexarm
