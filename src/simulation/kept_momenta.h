#pragma once
/// Changes velocities of a few nodes so that a mechanism has given momenta. (docs/notes/refinement.md 3)

#include <vector>

#include "integrators/energies.h"

namespace flexarm {

/// Changes the velocities of `nodes` by the smallest amount, measured by kinetic energy, with which the mechanism has
/// the linear and angular momenta `wanted`. Requires a scheme with rotary inertia at nodes. Momenta are exact up to
/// round-off, unless the nodes have no mass.
void keep_momenta(const Model& model, const Scheme& scheme, const std::vector<int>& nodes, const Momenta& wanted,
                  State& state);

}  // namespace flexarm
