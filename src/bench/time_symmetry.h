#pragma once
/// Does a step backwards undo a step forwards?

#include "bench/run.h"

namespace flexarm::bench {

/// free_tree, 40 steps of 50 ms; then all velocities are reversed and it is stepped as often. Largest distance of a
/// node from its start, relative to the largest distance on the way. Not for schemes with a memory of past strains
/// (NumericalDissipation): a time at which to reverse it does not exist.
std::optional<Measured<double>> time_asymmetry(const Variant& variant, bool quick);

}  // namespace flexarm::bench
