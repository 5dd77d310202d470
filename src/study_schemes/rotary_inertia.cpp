#include "study_schemes/rotary_inertia.h"

#include <cassert>

#include "elements/orders.h"

namespace flexarm {

template <int Nodes>
void add_rotary_rate(const BeamElement<Nodes>& element, int k, const RotaryRate& rate,
                     const GeneralisedShapeFunctions<Nodes>& generalised, bool with_tangent,
                     ElementSystem<Nodes>& system) {
  assert(k >= 0 && k < BeamElement<Nodes>::kMassPoints);
  const auto& constants = element.mass_points[k];
  for (int i = 0; i < Nodes; ++i)
    system.residual.template segment<3>(6 * i + 3) += constants.weight * constants.shape[i] * rate.moment;
  for (int j = 0; j < Nodes && with_tangent; ++j) {
    const Matrix3 column = constants.weight * rate.derivative * generalised.values[j];
    for (int i = 0; i < Nodes; ++i)
      system.tangent.template block<3, 3>(6 * i + 3, 6 * j + 3) += constants.shape[i] * column;
  }
}

RotaryRate average_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                               const Vector3& increment, const Matrix3& inverse_tangent, const MassPointState& state,
                               double step, bool with_derivative) {
  assert(step != 0);
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

RotaryRate newmark_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
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

RotaryRate momentum_rotary_rate(const Matrix3& inertia, const Matrix3& begin, const Matrix3& end,
                                const MassPointState& state, const Vector3& begin_rate, const NewmarkRule& rule) {
  assert(rule.gamma != 0 && rule.step != 0);
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

// Explicit instantiations for each order of elements.
#define COMPILE_FOR(Nodes) template decltype(add_rotary_rate<Nodes>) add_rotary_rate<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
