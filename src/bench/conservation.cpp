#include "bench/conservation.h"

#include <algorithm>

#include "bench/scenes.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

double total_mass(const Model& model) {
  double mass = 0;
  for (const NodalInertia& inertia : model.inertias) mass += inertia.total_mass;
  return mass;
}

}  // namespace

Measured<InvariantDrift> invariant_drift(const Variant& variant, bool quick) {
  Simulation tree = simulation(free_tree(), variant, 0.01);
  const Vector3 linear = tree.momentum(), angular = tree.angular_momentum();
  const Energies begin = tree.energies();
  double lowest = begin.total(), energy_scale = lowest, linear_scale = std::sqrt(2 * total_mass(model_of(tree)));
  linear_scale *= std::sqrt(begin.kinetic);
  InvariantDrift drift;
  const std::optional<Failure> failure = run(tree, quick ? 100 : 2000, [&](const StepResult&) {
    const double energy = tree.energies().total();
    drift.energy = std::max(drift.energy, std::abs(energy - begin.total()));
    drift.growth = std::max(drift.growth, energy - lowest);
    drift.linear_momentum = std::max(drift.linear_momentum, (tree.momentum() - linear).norm());
    drift.angular_momentum = std::max(drift.angular_momentum, (tree.angular_momentum() - angular).norm());
    lowest = std::min(lowest, energy);
  });
  drift.energy /= energy_scale;
  drift.growth /= energy_scale;
  drift.linear_momentum /= linear_scale;
  drift.angular_momentum /= angular.norm();
  return {failure, drift};
}

}  // namespace flexarm::bench
