#pragma once
/// Measures whether a step backwards undoes a step forwards.

#include "bench/run.h"

namespace flexarm::bench {

/// Makes 40 steps of 50 ms with free_tree, reverses all velocities, and makes 40 more steps. The result is the largest
/// distance of a node from its initial position, relative to the largest distance on the way. Empty for schemes with a
/// memory of past strains (NumericalDissipation), since their state cannot be reversed.
std::optional<Measured<double>> time_asymmetry(const Variant& variant, bool quick);

}  // namespace flexarm::bench
