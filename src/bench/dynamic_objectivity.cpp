#include "bench/dynamic_objectivity.h"

#include <algorithm>
#include <vector>

#include "bench/scenes.h"
#include "math/so3.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

struct Twisting {
  double twist, angular_velocity;
};

/// A run in which nodes and mass points spin at the rate `mean`, plus or minus `relative` at the beam's ends [rad/s].
Measured<std::vector<Twisting>> twisting(const Variant& variant, double mean, double relative) {
  Simulation bar = simulation(free_bar(), variant, 0.1);
  const auto& element = std::get<BeamGroup<2>>(model_of(bar).beams).elements.front();
  const int first = element.nodes[0], last = element.nodes[1];
  State state = state_of(bar);
  state.nodes[first].angular_velocity.x() = mean - relative;
  state.nodes[last].angular_velocity.x() = mean + relative;
  for (std::size_t k = 0; k < element.mass_points.size() && !variant.scheme.nodal_rotary_inertia; ++k) {
    const auto& shape = element.mass_points[k].shape;
    state.study.mass_points[element.first_mass_point + k].angular_velocity.x() =
        mean + relative * (shape[1] - shape[0]);
  }
  for (StrainMemory& memory : state.strain_memory)
    memory.rate[3] = 2 * relative;  // rate of twist; the beam is 1 m long
  restore(bar, state);
  Measured<std::vector<Twisting>> out;
  out.failure = run(bar, 12, [&](const StepResult&) {
    const State& now = state_of(bar);
    const Quaternion between = now.nodes[first].orientation.conjugate() * now.nodes[last].orientation;
    Twisting twisting;
    twisting.twist = so3::log(between).x();
    if (variant.scheme.nodal_rotary_inertia)
      twisting.angular_velocity = now.nodes[last].angular_velocity.x() - now.nodes[first].angular_velocity.x();
    else
      twisting.angular_velocity = now.study.mass_points[element.first_mass_point + 1].angular_velocity.x() -
                                  now.study.mass_points[element.first_mass_point].angular_velocity.x();
    out.value.push_back(twisting);
  });
  return out;
}

}  // namespace

Measured<SpinDependence> spin_dependence(const Variant& variant) {
  const auto at_rest = twisting(variant, 0, 0.5), spinning = twisting(variant, 5, 0.5);
  for (const auto* measured : {&at_rest, &spinning})
    if (measured->failure) return {measured->failure, {}};
  SpinDependence change;
  Twisting largest{0, 0};
  for (std::size_t n = 0; n < at_rest.value.size(); ++n) {
    const Twisting &a = at_rest.value[n], &b = spinning.value[n];
    change.twist = std::max(change.twist, std::abs(b.twist - a.twist));
    change.angular_velocity = std::max(change.angular_velocity, std::abs(b.angular_velocity - a.angular_velocity));
    largest.twist = std::max(largest.twist, std::abs(a.twist));
    largest.angular_velocity = std::max(largest.angular_velocity, std::abs(a.angular_velocity));
  }
  return {{}, {change.twist / largest.twist, change.angular_velocity / largest.angular_velocity}};
}

}  // namespace flexarm::bench
