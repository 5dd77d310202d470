#include "simulation/rebuilt.h"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "integrators/energies.h"
#include "simulation/carried_state.h"
#include "simulation/inside.h"

namespace flexarm {

void go_on_with(Simulation& simulation, const State& state, const scene::SceneDescription& scene,
                const std::set<std::string>& touched, EnergyChange change) {
  if (!state.left_lines.empty())
    throw std::invalid_argument(
        "a slider has left its line: nothing can be attached, detached, spawned or deleted then");
  Simulation next = with_settings_of(simulation, scene);
  if (const auto link = link_with_other_mesh(model_of(simulation), model_of(next)))
    throw std::invalid_argument(fmt::format("link '{}' would get another mesh", *link));
  State carried = carried_state({simulation.scene(), model_of(simulation)}, state, {next.scene(), model_of(next)},
                                touched, [&](State& placed) { begin(next, placed); });
  const Energies before = simulation.energies();
  const Energies after = energies(model_of(next), scheme_of(next), carried);
  // The two models may measure potential energy from different heights, so that a difference in it is no loss.
  if (change == EnergyChange::Dissipated) {
    carried.dissipated += before.kinetic + before.strain - after.kinetic - after.strain;
    carried.work += after.potential - before.potential;
  } else {
    carried.work += after.total() - before.total();
  }
  restore(next, carried);
  simulation = std::move(next);
}

}  // namespace flexarm
