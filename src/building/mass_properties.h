#pragma once
/// Mass properties that need the finished mechanism (internal to building/).

#include <vector>

#include "model/model.h"

namespace flexarm {

/// Gives the stops of limited coordinates the inertia that they feel. `node_parents`: see Mechanism.
/// @return coordinates that are free to move, and move nothing that has inertia, directly or through what follows them.
std::vector<int> finish_mass_properties(const std::vector<int>& node_parents, Model& model);

}  // namespace flexarm
