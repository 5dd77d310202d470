#pragma once
/// Beam elements and rigid bodies (internal to building/).

#include <vector>

#include "building/mechanism.h"

namespace flexarm {

/// Lumps rigid bodies on nodes; each gets one in its centre of mass.
MassiveTree add_inertia(const ScenePlan& plan, PlacedTree tree);

/// int I^i ds of the nodes of a flexible link, over its elements between two arc lengths, which are borders [m].
std::vector<double> length_weights(const ScenePlan& plan, const Model& model, int link, double from, double to);

}  // namespace flexarm
