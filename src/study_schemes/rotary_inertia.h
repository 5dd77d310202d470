#pragma once
/// Rotary inertia of beams at the mass points, for schemes that do not lump it at the nodes (Newmark family, M1).

#include "elements/conserving_node.h"
#include "math/so3.h"
#include "model/study_memory.h"
#include "study_schemes/element_nodes.h"
#include "study_schemes/newmark_rule.h"

namespace flexarm {

/// Rate of the angular momentum of a rotary inertia over a step, and its derivative with respect to the spin at the
/// end.
struct RotaryRate {
  Vector3 moment;           ///< world axes [N m]
  Matrix3 derivative;       ///< d(moment)/d(spin)
  MassPointState end;       ///< angular velocity and acceleration at the end
  Vector3 energy_gradient;  ///< d(W.J W / 2)/d(spin) at the end; set only by the average rule, with the derivative
};

/// The average rule, see AverageRate.
RotaryRate average_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                               const Vector3& increment, const Matrix3& inverse_tangent, const MassPointState& state,
                               double step, bool with_derivative = true);

/// Newmark's rule: Lambda (W x J W + J A) at the end, with the unscaled material increment (Muñoz 2004, eq. 4.5;
/// beam.md 2.5).
RotaryRate newmark_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                               const MassPointState& state, const NewmarkRule& rule);

/// The momentum-rate form (Muñoz 2004, eq. 4.13): the rate of l = Lambda J W at the end, by Newmark's rule for
/// velocities applied to l: (l_1 - l_0) / (gamma h) + (gamma - 1)/gamma (dl/dt)_0.
RotaryRate momentum_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                const MassPointState& state, const Vector3& begin_rate, const NewmarkRule& rule);

/// Calls visit(k, rotation at the end, generalised shape functions) for the mass points of an element. The functions
/// are set only `with_variation`.
template <int Nodes, class Visit>
void for_each_mass_point(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_variation,
                         const Visit& visit) {
  const ElementRotations<Nodes> rotations(nodes, with_variation);
  for (int k = 0; k < BeamElement<Nodes>::kMassPoints; ++k) {
    const auto& constants = element.mass_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    const auto* reference = nodes.mass_reference ? nodes.mass_reference + k : nullptr;
    visit(k, rotations.evaluate(constants.shape, constants.derivative, reference, generalised), generalised);
  }
}

/// Adds the rate of angular momentum at mass point k to the moment rows, tested with Lagrange functions.
template <int Nodes>
void add_rotary_rate(const BeamElement<Nodes>& element, int k, const RotaryRate& rate,
                     const GeneralisedShapeFunctions<Nodes>& generalised, bool with_tangent,
                     ElementSystem<Nodes>& system);

}  // namespace flexarm
