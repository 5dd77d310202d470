// What beams contribute to residual and tangent of a step.
#include "elements/additive_beam.h"
#include "elements/element_configuration.h"
#include "integrators/step_system.h"
#include "math/so3.h"

namespace flexarm {

template <int Nodes>
void StepSystem::gather_nodes(const BeamElement<Nodes>& element, const std::vector<NodePose>& end,
                              ElementNodes<Nodes>& nodes) const {
  for (int i = 0; i < Nodes; ++i) {
    const int node = element.nodes[i];
    nodes.begin[i] = begin_[node].position;
    nodes.end[i] = end[node].position;
    nodes.orientation[i] = end[node].orientation;
    nodes.increment[i] = increments_[node];
    nodes.increment_inverse_tangent[i] = inverse_tangents_[node];
    nodes.velocity[i] = state_->nodes[node].velocity;
    nodes.acceleration[i] = state_->nodes[node].acceleration;
  }
  reference_.gather(element, nodes);
}

template <int Nodes>
void StepSystem::scatter(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, bool with_tangent) {
  dissipated_ += system.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    Eigen::Map<Vector6>(rows_.at(element.nodes[i])) += system.residual.template segment<6>(6 * i);
    for (int j = 0; j < Nodes && with_tangent; ++j)
      Eigen::Map<Matrix6>(backend_->element_block(element.first_block + i * Nodes + j)) +=
          system.tangent.template block<6, 6>(6 * i, 6 * j);
  }
}

template <int Nodes>
void StepSystem::interpolate_forces(const BeamElement<Nodes>& element, bool with_tangent,
                                    ElementSystem<Nodes>& system) {
  for (int i = 0; i < Nodes; ++i) end_forces_[element.nodes[i]] += system.residual.template segment<6>(6 * i);
  if (static_) return;
  system.residual.setZero();  // interpolated for whole nodes
  const double factor = 1 + scheme_.alpha;
  for (int i = 0; i < Nodes && with_tangent; ++i) {
    const int node = element.nodes[i];
    if (scheme_.hht == HhtForm::Kinematics) {
      system.tangent.template middleCols<3>(6 * i) *= factor;
      auto spin = system.tangent.template middleCols<3>(6 * i + 3);
      spin = (spin * interpolated_spins_[node]).eval();
    } else {
      const Matrix3 slope = interpolated_moment(node, Vector3::Zero(), Vector3::Zero(), false).slope;
      system.tangent.template middleRows<3>(6 * i) *= factor;
      auto moment = system.tangent.template middleRows<3>(6 * i + 3);
      moment = (slope * moment).eval();
    }
  }
}

template <int Nodes>
void StepSystem::add_average_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                                    bool with_tangent, ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& system) {
  const bool is_scaled = scheme_.beam_rotation == RotationRule::TangentScaled;
  const int first = element.first_mass_point;
  const bool with_derivative = with_tangent || energy;
  for_each_mass_point(element, nodes, with_derivative,
                      [&](int k, const PointRotation& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
                        const Matrix3& begin = begin_mass_rotations_[first + k];
                        const MassPointState& state = state_->mass_points[first + k];
                        const Quaternion relative = so3::quaternion_from_matrix(point.rotation * begin.transpose());
                        const Vector3 increment = is_scaled ? cayley::increment(relative) : so3::log(relative);
                        const Matrix3 inverse =
                            is_scaled ? cayley::inverse_tangent(increment) : so3::inverse_tangent(increment);
                        const RotaryRate rate = average_rotary_rate(element.inertia, begin, point.rotation, increment,
                                                                    inverse, state, step_, with_derivative);
                        end_mass_rotations_[first + k] = point.rotation;
                        end_mass_points_[first + k] = rate.end;
                        add_rotary_rate(element, k, rate, generalised, with_tangent, system);
                        if (!energy) return;
                        const Vector3 &before = state.angular_velocity, &after = rate.end.angular_velocity;
                        const double weight = element.mass_points[k].weight;
                        energy->change += 0.5 * weight * (after - before).dot(element.inertia * (after + before));
                        for (int i = 0; i < Nodes; ++i)
                          energy->gradient.template segment<3>(6 * i + 3) +=
                              weight * (generalised.values[i].transpose() * rate.energy_gradient);
                      });
}

template <int Nodes>
void StepSystem::add_newmark_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                                    bool with_tangent, ElementSystem<Nodes>& system) {
  const int first = element.first_mass_point;
  const NewmarkRule rule = newmark();
  for_each_mass_point(element, nodes, with_tangent,
                      [&](int k, const PointRotation& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
                        const MassPointState& state = state_->mass_points[first + k];
                        const Matrix3& begin = begin_mass_rotations_[first + k];
                        const RotaryRate rate =
                            scheme_.hht == HhtForm::None
                                ? newmark_rotary_rate(element.inertia, begin, point.rotation, state, rule)
                                : momentum_rotary_rate(element.inertia, begin, point.rotation, state,
                                                       state_->momentum_rates[first + k], rule);
                        end_mass_rotations_[first + k] = point.rotation;
                        end_mass_points_[first + k] = rate.end;
                        end_momentum_rates_[first + k] = rate.moment;
                        if (scheme_.weak_form == WeakForm::Additive)
                          add_additive_rotary_rate(element, nodes, k, rate, with_tangent, system);
                        else
                          add_rotary_rate(element, k, rate, generalised, with_tangent, system);
                      });
}

void StepSystem::add_momentum_beams(bool with_tangent) {
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    gather_nodes(element, end_, nodes);
    const auto rotary = [&](bool tangent, ElementEnergy<N>* energy, ElementSystem<N>& sum) {
      add_average_rotary(element, nodes, tangent, energy, sum);
    };
    momentum_beam<N>(element, nodes, scheme_, &begin_points_[first], step_, rotary, with_tangent, &end_points_[first],
                     system);
    scatter(element, system, with_tangent);
  });
}

void StepSystem::initialise_strain_memory(State& state) {
  state.strain_memory.assign(model_.stiffness_point_count, StrainMemory());
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotationVariation<N> local{LocalRotations<N>(nodes.orientation)};
    for (int k = 0; k < N - 1; ++k) {
      const auto& constants = element.stiffness_points[k];
      GeneralisedShapeFunctions<N> functions;
      const PointKinematics point =
          point_kinematics(local.evaluate(constants.shape, constants.derivative, functions),
                           interpolate<N>(constants.derivative, nodes.position), constants.reference_strain);
      Eigen::Matrix<double, 9, 1> rate = Eigen::Matrix<double, 9, 1>::Zero();  // of {r', spin, spin'}
      rate.head<3>() = interpolate<N>(constants.derivative, nodes.velocity);
      for (int i = 0; i < N; ++i) {
        rate.segment<3>(3) += functions.values[i] * nodes.spin[i];
        rate.tail<3>() += functions.derivatives[i] * nodes.spin[i];
      }
      StrainMemory& memory = state.strain_memory[element.first_stiffness_point + k];
      memory.rate = memory.delayed_rate = strain_derivative(point) * rate;
    }
  });
}

void StepSystem::add_endpoint_forces(bool with_tangent) {
  const NewmarkRule rule = newmark();
  const bool is_additive = scheme_.weak_form == WeakForm::Additive;
  const std::vector<NodePose>& end = is_interpolated() ? interpolated_ : end_;
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    gather_nodes(element, end, nodes);
    const auto internal = is_additive ? additive_internal<N> : endpoint_internal<N>;
    internal(element, nodes, static_ ? nullptr : &rule, &begin_points_[first], state_->strain_rates.data() + first,
             with_tangent, &end_points_[first], &end_strain_rates_[first], system);
    if (is_additive) additive_to_spins(nodes, with_tangent, system);
    if (!static_ && scheme_.hht != HhtForm::Kinematics)
      newmark_mass_damping<N>(element, nodes, rule, with_tangent, system);
    if (scheme_.hht != HhtForm::None) interpolate_forces(element, with_tangent, system);
    scatter(element, system, with_tangent);
  });
}

void StepSystem::add_newmark_inertia(bool with_tangent) {
  const NewmarkRule rule = newmark();
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    gather_nodes(element, end_, nodes);
    add_newmark_rotary(element, nodes, with_tangent, system);
    if (scheme_.weak_form == WeakForm::Additive) additive_to_spins(nodes, with_tangent, system);
    newmark_translation<N>(element, nodes, rule, with_tangent, system);
    if (scheme_.hht == HhtForm::Kinematics) newmark_mass_damping<N>(element, nodes, rule, with_tangent, system);
    scatter(element, system, with_tangent);
  });
}

}  // namespace flexarm
