#pragma once
/// Checks whether a state is one that the simulator could have reached.

#include <string>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Says why `state` cannot be a state of a simulation: the quantity, its value, and what was expected. Empty if nothing
/// is wrong. `built`: the model before any slider has left its line. `initial`: a state of that model with the same
/// scheme. `finest_halving`: the highest halving_level.
std::string state_flaw(const Model& built, const State& initial, int finest_halving, const State& state);

}  // namespace flexarm
