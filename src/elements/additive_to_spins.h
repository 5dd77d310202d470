#pragma once
/// The additive weak form's coordinates.

#include "elements/beam_point.h"

namespace flexarm {

/// From {r, theta} to {r, spin} of the nodes: rows T_i^{-T}, columns T_j^{-1}, and the variation of the former.
template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
