#pragma once
/// Rotary inertia of beams integrated at the mass points with local interpolation (Newmark family, M1), and the rules
/// by which a material angular velocity follows a rotation increment. The EM schemes lump it at the nodes instead.

#include "flexarm/elements/beam_point.h"
#include "flexarm/elements/endpoint_beam.h"
#include "flexarm/math/cayley.h"
#include "flexarm/math/so3.h"
#include "flexarm/model/state.h"

namespace flexarm {

/// Momentum rate of a rotary inertia over a step and its derivative with respect to the spin at the end.
struct RotaryRate {
  Vector3 moment;      ///< world axes [N m]
  Matrix3 derivative;  ///< d(moment)/d(spin)
  MassPointState end;  ///< angular velocity and acceleration at the end
};

/// Average rule: (Lambda_1 J W_1 - Lambda_0 J W_0) / h with (W_0 + W_1) / 2 = Omega / h. `increment` is the spatial
/// rotation increment (unscaled or tangent-scaled), `inverse_tangent` maps a spin to its variation (T^{-1} or S^{-1}),
/// and is used for the derivative only.
inline RotaryRate average_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                      const Vector3& increment, const Matrix3& inverse_tangent,
                                      const MassPointState& state, double step, bool with_derivative = true) {
  RotaryRate rate;
  rate.end.angular_velocity = (2 / step) * (begin.transpose() * increment) - state.angular_velocity;
  const Vector3 momentum = end * (inertia * rate.end.angular_velocity);
  rate.moment = (momentum - begin * (inertia * state.angular_velocity)) / step;
  if (!with_derivative) return rate;
  const Matrix3 to_material = begin.transpose() * inverse_tangent, to_momentum = inertia * to_material;
  rate.derivative = (2 / (step * step)) * (end * to_momentum) - so3::hat(Vector3(momentum / step));
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

/// Adds int I^i (moment rate) ds of one element. `rate(point index, begin rotation, end rotation)` returns a
/// RotaryRate; `begin`, `end`: section rotations at the mass points.
template <int Nodes, class Rate>
void add_rotary_inertia(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const Matrix3* begin,
                        const Rate& rate, bool with_tangent, Matrix3* end, ElementSystem<Nodes>& system) {
  const ElementRotations<Nodes> rotations(nodes.orientation, with_tangent);
  for (int k = 0; k < BeamElement<Nodes>::kMassPoints; ++k) {
    const auto& constants = element.mass_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    end[k] = rotations.evaluate(constants.shape, constants.derivative, generalised).rotation;
    const RotaryRate r = rate(k, begin[k], end[k]);
    for (int i = 0; i < Nodes; ++i)
      system.residual.template segment<3>(6 * i + 3) += constants.weight * constants.shape[i] * r.moment;
    if (!with_tangent) continue;
    for (int j = 0; j < Nodes; ++j) {
      const Matrix3 column = constants.weight * r.derivative * generalised.values[j];
      for (int i = 0; i < Nodes; ++i)
        system.tangent.template block<3, 3>(6 * i + 3, 6 * j + 3) += constants.shape[i] * column;
    }
  }
}

}  // namespace flexarm
