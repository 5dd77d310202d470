#include "study_schemes/momentum_beams.h"

#include <algorithm>

#include "math/so3.h"

namespace flexarm {

template <int Nodes>
void MomentumBeams::add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                               ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system) {
  const bool is_scaled = configuration_.scheme().beam_rotation == RotationRule::TangentScaled;
  const int first = element.first_mass_point;
  const bool with_derivative = with_tangent || energy;
  for_each_mass_point(
      element, nodes, with_derivative,
      [&](int k, const PointRotation& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
        const Matrix3& begin = points_.begin_rotations[first + k];
        const MassPointState& state = configuration_.state().study.mass_points[first + k];
        const Quaternion relative = so3::quaternion_from_matrix(point.rotation * begin.transpose());
        const Vector3 increment = is_scaled ? cayley::increment(relative) : so3::log(relative);
        const Matrix3 inverse = is_scaled ? cayley::inverse_tangent(increment) : so3::inverse_tangent(increment);
        const RotaryRate rate = average_rotary_rate(element.mass_points[k].inertia, begin, point.rotation, increment,
                                                    inverse, state, configuration_.step(), with_derivative);
        points_.end_rotations[first + k] = point.rotation;
        points_.end_motion[first + k] = rate.end;
        add_rotary_rate(element, k, rate, generalised, with_tangent, system);
        if (!energy) return;
        const Vector3 &before = state.angular_velocity, &after = rate.end.angular_velocity;
        const auto& [shape, derivative, weight, inertia] = element.mass_points[k];
        energy->change += 0.5 * weight * (after - before).dot(inertia * (after + before));
        for (int i = 0; i < Nodes; ++i)
          energy->gradient.template segment<3>(6 * i + 3) +=
              weight * (generalised.values[i].transpose() * rate.energy_gradient);
      });
}

void MomentumBeams::add_forces(Balance& balance) {
  if (balance.tangent) points_.set_inverse_tangents();
  points_.reference.set_trial(configuration_.end());
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    points_.gather(element, configuration_.end(), nodes);
    const auto rotary = [&](bool tangent, ElementEnergy<N>* energy, ElementSystem<N>& sum) {
      add_rotary(element, nodes, tangent, energy, sum);
    };
    momentum_beam<N>(element, nodes, configuration_.scheme(), &points_.begin_stiffness[first], configuration_.step(),
                     std::cref(rotary), balance.tangent != nullptr, &points_.end_stiffness[first], system,
                     points_.carried(first, balance));
    balance.add(element, system, true);
  });
  if (balance.tangent) points_.drop_carried();
  bodies_.for_each_damping(balance.tangent != nullptr, [&](int node, const NodalAction& damping) {
    balance.residual.node(node) += damping.residual;
    balance.dissipated += damping.dissipated;
    if (!balance.tangent) return;
    Matrix6 tangent = Matrix6::Zero();
    tangent.bottomRightCorner<3, 3>() = damping.rotational;
    balance.tangent->add_to_node(node, tangent);
  });
}

void MomentumBeams::accept(State& state) {
  bodies_.accept(state);
  std::copy(points_.end_motion.begin(), points_.end_motion.end(), state.study.mass_points.begin());
  points_.accept(state);
}

}  // namespace flexarm
