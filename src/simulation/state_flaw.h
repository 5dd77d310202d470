#pragma once
/// Checks whether a state is one that the simulator could have reached.

#include <string>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Why `state` is not one of a simulation: the quantity, its value, and what was expected. Empty if nothing is wrong.
/// `built`: the model before anything has left its line; `initial`: a state of it with the same scheme;
/// `finest_halving`: the highest halving_level.
std::string state_flaw(const Model& built, const State& initial, int finest_halving, const State& state);

}  // namespace flexarm
