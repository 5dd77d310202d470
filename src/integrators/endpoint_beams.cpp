#include "integrators/endpoint_beams.h"

#include <algorithm>

#include "elements/additive_beam.h"
#include "elements/nodal_inertia.h"

namespace flexarm {

EndpointBeams::EndpointBeams(const StepConfiguration& configuration, const StepPrestrains& prestrains)
    : configuration_(configuration),
      points_(configuration, prestrains),
      end_strain_rates_(configuration.model().stiffness_point_count, Vector6::Zero()),
      end_momentum_rates_(configuration.model().mass_point_count, Vector3::Zero()) {}

void EndpointBeams::begin() {
  const Scheme& scheme = configuration_.scheme();
  rule_ = newmark_rule(scheme, configuration_.step());
  if (scheme.is_static) points_.invalidate();
  points_.begin(may_carry());
}

void EndpointBeams::add_forces(Balance& balance) {
  const std::vector<NodePose>& end = interpolation_ ? interpolation_->configuration() : configuration_.end();
  const bool with_tangent = balance.tangent, is_static = configuration_.scheme().is_static;
  points_.reference.set_trial(end);
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const int first = element.first_stiffness_point;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    points_.gather(element, end, nodes);
    const auto internal = is_additive()                                ? endpoint_internal<N, AdditiveForm>
                          : configuration_.scheme().tests_vary_strains ? endpoint_internal<N, VariationForm>
                                                                       : endpoint_internal<N, SpinForm>;
    internal(element, nodes, is_static ? nullptr : &rule_, &points_.begin_stiffness[first],
             configuration_.state().strain_rates.data() + first, with_tangent, &points_.end_stiffness[first],
             &end_strain_rates_[first], system, points_.carried(first, balance));
    if (is_additive()) additive_to_spins(nodes, with_tangent, system);
    if (!is_static && !interpolates_kinematics()) newmark_mass_damping<N>(element, nodes, rule_, with_tangent, system);
    if (interpolation_) interpolation_->take(element, with_tangent, system);
    scatter(element, system, balance, true);
  });
  if (with_tangent) points_.drop_carried();
}

void EndpointBeams::initialise(State& state) {
  points_.reference.initialise(state);
  if (!interpolation_) return;
  points_.invalidate();
  points_.begin(false);
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    for (std::size_t k = 0; k < element.mass_points.size(); ++k) {
      const int index = element.first_mass_point + static_cast<int>(k);
      const MassPointState& point = state.mass_points[index];
      state.momentum_rates[index] =
          momentum_rate(points_.begin_rotations[index], element.mass_points[k].inertia, point);
    }
  });
  points_.invalidate();
}

template <int Nodes>
void EndpointBeams::add_rotary(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, bool with_tangent,
                               ElementSystem<Nodes>& system) {
  const int first = element.first_mass_point;
  const State& before = configuration_.state();
  for_each_mass_point(element, nodes, with_tangent,
                      [&](int k, const PointRotation& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
                        const MassPointState& state = before.mass_points[first + k];
                        const Matrix3& begin = points_.begin_rotations[first + k];
                        const Matrix3& inertia = element.mass_points[k].inertia;
                        const RotaryRate rate = interpolation_
                                                    ? momentum_rotary_rate(inertia, begin, point.rotation, state,
                                                                           before.momentum_rates[first + k], rule_)
                                                    : newmark_rotary_rate(inertia, begin, point.rotation, state, rule_);
                        points_.end_rotations[first + k] = point.rotation;
                        points_.end_motion[first + k] = rate.end;
                        end_momentum_rates_[first + k] = rate.moment;
                        if (is_additive())
                          add_additive_rotary_rate(element, nodes, k, rate, with_tangent, system);
                        else
                          add_rotary_rate(element, k, rate, generalised, with_tangent, system);
                      });
}

void EndpointBeams::add_inertia(Balance& balance) {
  const bool with_tangent = balance.tangent;
  if (interpolates_kinematics()) points_.reference.set_trial(configuration_.end());
  for_each_element(configuration_.model().beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    ElementNodes<N> nodes;
    ElementSystem<N> system;
    system.set_zero();
    points_.gather(element, configuration_.end(), nodes);
    add_rotary(element, nodes, with_tangent, system);
    if (is_additive()) additive_to_spins(nodes, with_tangent, system);
    newmark_translation<N>(element, nodes, rule_, with_tangent, system);
    if (interpolates_kinematics()) newmark_mass_damping<N>(element, nodes, rule_, with_tangent, system);
    scatter(element, system, balance, false);
  });
}

void EndpointBeams::accept(State& state) {
  if (!configuration_.scheme().is_static) {
    std::copy(points_.end_motion.begin(), points_.end_motion.end(), state.mass_points.begin());
    std::copy(end_strain_rates_.begin(), end_strain_rates_.end(), state.strain_rates.begin());
  }
  if (interpolation_) std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(), state.momentum_rates.begin());
  points_.accept(state);
  if (interpolates_kinematics()) points_.invalidate();  // the present points belong to t_{n+1+alpha}
}

}  // namespace flexarm
