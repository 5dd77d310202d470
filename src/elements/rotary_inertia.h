#pragma once
/// Rotary inertia of beams integrated at the mass points with local interpolation (Newmark family, M1), and the rules
/// by which a material angular velocity follows a rotation increment. The EM schemes lump it at the nodes instead.

#include "elements/beam_point.h"
#include "elements/endpoint_beam.h"
#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {

/// Momentum rate of a rotary inertia over a step and its derivative with respect to the spin at the end.
struct RotaryRate {
  Vector3 moment;           ///< world axes [N m]
  Matrix3 derivative;       ///< d(moment)/d(spin)
  MassPointState end;       ///< angular velocity and acceleration at the end
  Vector3 energy_gradient;  ///< of W.J W / 2 at the end, with respect to the spin; average rule, with the derivative
};

/// Average rule: (Lambda_1 J W_1 - Lambda_0 J W_0) / h with (W_0 + W_1) / 2 = Omega / h. `increment` is the spatial
/// rotation increment (unscaled or tangent-scaled), `inverse_tangent` maps a spin to its variation (T^{-1} or S^{-1}),
/// and is used for the derivative only. On a scalar or on packs.
template <typename S>
struct AverageRate {
  Vector3T<S> angular_velocity;  ///< at the end, material
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

inline RotaryRate average_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                      const Vector3& increment, const Matrix3& inverse_tangent,
                                      const MassPointState& state, double step, bool with_derivative = true) {
  const AverageRate<double> average(inertia, begin, end, increment, inverse_tangent, state.angular_velocity, step,
                                    with_derivative);
  RotaryRate rate;
  rate.end.angular_velocity = average.angular_velocity;
  rate.moment = average.moment;
  if (!with_derivative) return rate;
  rate.derivative = average.derivative;
  rate.energy_gradient = (2 / step) * (average.to_momentum.transpose() * average.angular_velocity);
  return rate;
}

/// Newmark: Lambda (W x J W + J A) at the end, with the unscaled material increment (Muñoz 2004, eq. 4.5; beam.md 2.5).
inline RotaryRate newmark_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                      const MassPointState& state, const NewmarkRule& rule) {
  const Vector3 increment = so3::log(Matrix3(end * begin.transpose()));
  RotaryRate rate;
  rate.end.angular_acceleration =
      rule.acceleration(begin.transpose() * increment, state.angular_velocity, state.angular_acceleration);
  rate.end.angular_velocity =
      rule.velocity(state.angular_velocity, state.angular_acceleration, rate.end.angular_acceleration);
  const Vector3& W = rate.end.angular_velocity;
  const Vector3 JW = inertia * W;
  rate.moment = end * (W.cross(JW) + inertia * rate.end.angular_acceleration);
  const Matrix3 slope =
      rule.velocity_slope() * (so3::hat(W) * inertia - so3::hat(JW)) + rule.acceleration_slope() * inertia;
  rate.derivative = -so3::hat(rate.moment) + end * slope * begin.transpose() * so3::inverse_tangent(increment);
  return rate;
}

/// Momentum-rate form (Muñoz 2004, eq. 4.13): d(Lambda J W)/dt at the end by the rule that gives Newmark's velocities,
/// (l_1 - l_0) / (gamma h) + (gamma - 1)/gamma (dl/dt)_0.
inline RotaryRate momentum_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                       const MassPointState& state, const Vector3& begin_rate,
                                       const NewmarkRule& rule) {
  RotaryRate rate = newmark_rotary_rate(inertia, begin, end, state, rule);
  const Vector3 momentum = end * (inertia * rate.end.angular_velocity),
                increment = so3::log(Matrix3(end * begin.transpose()));
  const double c = 1 / (rule.gamma * rule.step);
  rate.moment =
      c * (momentum - begin * (inertia * state.angular_velocity)) + ((rule.gamma - 1) / rule.gamma) * begin_rate;
  rate.derivative = c * (rule.velocity_slope() * (end * inertia * begin.transpose() * so3::inverse_tangent(increment)) -
                         so3::hat(momentum));
  return rate;
}

/// Visits the mass points of an element: `visit(k, rotation at the end, generalised functions)`, the latter only with
/// `with_variation`.
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

/// Adds the moment rate at mass point k to the moment rows, tested with the Lagrange functions.
template <int Nodes>
void add_rotary_rate(const BeamElement<Nodes>& element, int k, const RotaryRate& rate,
                     const GeneralisedShapeFunctions<Nodes>& generalised, bool with_tangent,
                     ElementSystem<Nodes>& system) {
  const auto& constants = element.mass_points[k];
  for (int i = 0; i < Nodes; ++i)
    system.residual.template segment<3>(6 * i + 3) += constants.weight * constants.shape[i] * rate.moment;
  for (int j = 0; j < Nodes && with_tangent; ++j) {
    const Matrix3 column = constants.weight * rate.derivative * generalised.values[j];
    for (int i = 0; i < Nodes; ++i)
      system.tangent.template block<3, 3>(6 * i + 3, 6 * j + 3) += constants.shape[i] * column;
  }
}

}  // namespace flexarm
