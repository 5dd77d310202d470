#pragma once
/// The additive weak form of beams (Muñoz 2004, eq. 3.42; beam.md 2.2). It interpolates the nodes' total rotation
/// vectors, and its rows are conjugate to their variations. Unlike the spin form, it has a symmetric static tangent.

#include "elements/static_beam.h"
#include "study_schemes/rotary_inertia.h"

namespace flexarm {

/// A `Form` of endpoint_internal() with rows and columns {r_i, theta_i}. `nodes.rotation_vector` are total rotation
/// vectors, |theta| < 2 pi; the references of `nodes` are the undeformed points.
struct AdditiveForm {
  static constexpr bool needs_variation(bool) { return false; }

  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// Adds I^i T^T (rate of angular momentum) at mass point k to rows and columns {r_i, theta_i}.
template <int Nodes>
void add_additive_rotary_rate(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, int k,
                              const RotaryRate& rate, bool with_tangent, ElementSystem<Nodes>& system);

/// Transforms a system from {r, theta} to {r, spin} of the nodes: multiplies rows by T_i^{-T} and columns by T_j^{-1},
/// and adds the variation of T_i^{-T} to the tangent.
template <int Nodes>
void additive_to_spins(const ElementNodes<Nodes>& nodes, bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
