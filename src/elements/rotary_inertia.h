#pragma once
/// Rotary inertia of beams at the mass points (Newmark family, M1), and the rules by which schemes compute an angular
/// velocity from a rotation increment. The EM schemes lump the rotary inertia at the nodes.

#include "elements/beam_point.h"
#include "elements/endpoint_beam.h"
#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {

/// Rate of the angular momentum of a rotary inertia over a step, and its derivative with respect to the spin at the
/// end.
struct RotaryRate {
  Vector3 moment;           ///< world axes [N m]
  Matrix3 derivative;       ///< d(moment)/d(spin)
  MassPointState end;       ///< angular velocity and acceleration at the end
  Vector3 energy_gradient;  ///< d(W.J W / 2)/d(spin) at the end; set only by the average rule, with the derivative
};

/// The average rule: the rate is (Lambda_1 J W_1 - Lambda_0 J W_0) / h, with (W_0 + W_1) / 2 = Omega / h and the
/// material increment Omega. `increment` is the spatial rotation increment (unscaled or tangent-scaled).
/// `inverse_tangent` (T^{-1} or S^{-1}) maps a spin to the variation of `increment`; only the derivative needs it. S: a
/// scalar or a pack.
template <typename S>
struct AverageRate {
  Vector3T<S> angular_velocity;  ///< at the end, in the section's frame
  Vector3T<S> moment;            ///< world axes
  Matrix3T<S> derivative;        ///< d(moment)/d(spin)
  Matrix3T<S> to_momentum;       ///< J d(Omega)/d(spin)

  AverageRate(const Matrix3T<S>& inertia, const Matrix3T<S>& begin, const Matrix3T<S>& end,
              const Vector3T<S>& increment, const Matrix3T<S>& inverse_tangent,
              const Vector3T<S>& begin_angular_velocity, double step, bool with_derivative) {
    angular_velocity = S(2 / step) * (begin.transpose() * increment) - begin_angular_velocity;
    const Vector3T<S> begin_momentum = inertia * begin_angular_velocity, end_momentum = inertia * angular_velocity;
    const Vector3T<S> momentum = end * end_momentum;
    moment = S(1 / step) * (momentum - begin * begin_momentum);
    if (!with_derivative) return;
    to_momentum.noalias() = inertia.lazyProduct(Matrix3T<S>(begin.transpose().lazyProduct(inverse_tangent)));
    derivative = S(2 / (step * step)) * end.lazyProduct(to_momentum);
    derivative -= so3::hat(Vector3T<S>(S(1 / step) * momentum));
  }
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
