#include "integrators/endpoint_beams.h"

#include <algorithm>

#include "elements/additive_to_spins.h"
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

void EndpointBeams::accept(State& state) {
  if (!configuration_.scheme().is_static) {
    std::copy(points_.end_motion.begin(), points_.end_motion.end(), state.mass_points.begin());
    std::copy(end_strain_rates_.begin(), end_strain_rates_.end(), state.strain_rates.begin());
  }
  if (interpolation_) std::copy(end_momentum_rates_.begin(), end_momentum_rates_.end(), state.momentum_rates.begin());
  points_.accept(state);
  if (interpolates_kinematics()) points_.invalidate();  // those at hand belong to t_{n+1+alpha}
}

}  // namespace flexarm
