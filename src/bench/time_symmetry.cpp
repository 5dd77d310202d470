#include "bench/time_symmetry.h"

#include <algorithm>

#include "bench/scenes.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

double distance(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    largest = std::max(largest, (a.nodes[i].position - b.nodes[i].position).norm());
  return largest;
}

/// Reverses the sign of velocities; positions, accelerations and forces stay. Data of the predictor is dropped.
State reversed(State state) {
  for (NodeState& node : state.nodes) {
    node.velocity *= -1;
    node.angular_velocity *= -1;
    node.mean_spin *= -1;
  }
  for (MassPointState& point : state.study.mass_points) point.angular_velocity *= -1;
  for (Vector6& rate : state.study.strain_rates) rate *= -1;
  state.history.clear();
  return state;
}

}  // namespace

std::optional<Measured<double>> time_asymmetry(const Variant& variant, bool quick) {
  if (variant.scheme.dissipation.any()) return std::nullopt;
  const int steps = quick ? 10 : 40;
  Simulation tree = simulation(free_tree(), variant, 0.05);
  const State begin = state_of(tree);
  double amplitude = 0;
  std::optional<Failure> failure =
      run(tree, steps, [&](const StepResult&) { amplitude = std::max(amplitude, distance(state_of(tree), begin)); });
  if (failure) return Measured<double>{failure, 0};
  restore(tree, reversed(state_of(tree)));
  failure = run(tree, steps);
  return Measured<double>{failure, distance(state_of(tree), begin) / amplitude};
}

}  // namespace flexarm::bench
