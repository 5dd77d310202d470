// The inertia of EndpointBeams.
#include "elements/additive_to_spins.h"
#include "elements/nodal_inertia.h"
#include "integrators/endpoint_beams.h"

namespace flexarm {

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

}  // namespace flexarm
