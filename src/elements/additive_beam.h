#pragma once
/// The additive weak form (Muñoz 2004, eq. 3.42; beam.md 2.2): rows conjugate to the variations of the nodes' total
/// rotation vectors, which are interpolated. Unlike the spin form it has a symmetric static tangent.

#include "elements/endpoint_beam.h"
#include "elements/rotary_inertia.h"

namespace flexarm {

/// Internal forces and their tangent in {r_i, theta_i}, otherwise as endpoint_internal. `nodes.rotation_vector`: total
/// rotation vectors, |theta| < 2 pi; references: the undeformed points.
template <int Nodes>
void additive_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system);

/// Adds the moment rate at mass point k, I^i T^T (moment), in {r_i, theta_i}.
template <int Nodes>
void add_additive_rotary_rate(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, int k,
                              const RotaryRate& rate, bool with_tangent, ElementSystem<Nodes>& system);

/// From {r, theta} to {r, spin} of the nodes: rows T_i^{-T}, columns T_j^{-1}, and the variation of the former.
template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
