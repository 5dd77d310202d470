#pragma once
/// The tree's nodes, elementary joints and coordinates (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// From the root to the leaves, where the scene lets the joints' coordinates start.
/// @throws ModelError for a slide that cannot be.
PlacedTree place_tree(const ScenePlan& plan);

}  // namespace flexarm
