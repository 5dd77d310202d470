#pragma once
/// Sets positions and velocities of joint coordinates.

#include <vector>

#include "flexarm/model/results.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Returns the state after Simulation::set_joint_state(), except for what a scheme adds to an initial state, and for
/// the change of work.
/// @throws std::invalid_argument as set_joint_state() does.
State with_joint_state(const Model& model, const DegreesOfFreedom& dof, const State& state,
                       const std::vector<CoordinateState>& coordinates);

}  // namespace flexarm
