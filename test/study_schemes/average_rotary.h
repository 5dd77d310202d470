#pragma once
/// Rotary inertia at the mass points by the average rule, as in the momentum-conserving schemes.

#include "study_schemes/momentum_beam.h"
#include "study_schemes/rotary_inertia.h"

namespace flexarm::test {

/// Called by momentum_beam to add rotary inertia. Keeps the motion at the end of the step.
template <int Nodes>
struct AverageRotary {
  const BeamElement<Nodes>& element;
  const ElementNodes<Nodes>& nodes;
  RotationRule rule;
  const std::array<Matrix3, Nodes>& begin;
  const std::array<MassPointState, Nodes>& states;
  double step;
  std::array<Matrix3, Nodes> end_rotations = {};
  std::array<MassPointState, Nodes> end_states = {};

  void operator()(bool with_tangent, ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system) {
    const bool is_scaled = rule == RotationRule::TangentScaled;
    const bool with_derivative = with_tangent || energy;
    for_each_mass_point(
        element, nodes, with_derivative,
        [&](int k, const InterpolatedRotation<double>& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
          const Quaternion relative = so3::quaternion_from_matrix(point.rotation * begin[k].transpose());
          const Vector3 increment = is_scaled ? cayley::increment(relative) : so3::log(relative);
          const Matrix3 inverse = is_scaled ? cayley::inverse_tangent(increment) : so3::inverse_tangent(increment);
          const RotaryRate rate = average_rotary_rate(element.mass_points[k].inertia, begin[k], point.rotation,
                                                      increment, inverse, states[k], step, with_derivative);
          add_rotary_rate(element, k, rate, generalised, with_tangent, system);
          end_rotations[k] = point.rotation;
          end_states[k] = rate.end;
          if (!energy) return;
          const double weight = element.mass_points[k].weight;
          energy->change += weight * (kinetic(k, rate.end) - kinetic(k, states[k]));
          for (int i = 0; i < Nodes; ++i)
            energy->gradient.template segment<3>(6 * i + 3) +=
                weight * (generalised.values[i].transpose() * rate.energy_gradient);
        });
  }
  /// Rotary kinetic energy per length [J/m].
  double kinetic(int k, const MassPointState& state) const {
    return 0.5 * state.angular_velocity.dot(element.mass_points[k].inertia * state.angular_velocity);
  }
};

}  // namespace flexarm::test
