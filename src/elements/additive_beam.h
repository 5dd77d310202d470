#pragma once
/// The additive weak form (Muñoz 2004, eq. 3.42; beam.md 2.2): rows conjugate to the variations of the nodes' total
/// rotation vectors, which are interpolated. Unlike the spin form it has a symmetric static tangent.

#include "elements/beam_point.h"
#include "elements/endpoint_beam.h"
#include "elements/rotary_inertia.h"

namespace flexarm {

/// Form of endpoint_internal with rows and columns {r_i, theta_i}. `nodes.rotation_vector`: total rotation vectors,
/// |theta| < 2 pi; references: the undeformed points.
struct AdditiveForm {
  static constexpr bool needs_variation(bool) { return false; }

  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// Adds the moment rate at mass point k, I^i T^T (moment), in {r_i, theta_i}.
template <int Nodes>
void add_additive_rotary_rate(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, int k,
                              const RotaryRate& rate, bool with_tangent, ElementSystem<Nodes>& system);

/// From {r, theta} to {r, spin} of the nodes: rows T_i^{-T}, columns T_j^{-1}, and the variation of the former.
template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
