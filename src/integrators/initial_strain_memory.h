#pragma once
/// What numerical dissipation and structural damping remember at the start of a motion.

#include <vector>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Per stiffness point: the strain rates that the velocities of `state` mean [1/s, 1/(m s)].
std::vector<StrainMemory> initial_strain_memory(const Model& model, const State& state);

}  // namespace flexarm
