#pragma once
/// A simulation that goes on with a scene to which links were added, or from which some were taken.

#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "model/state.h"

namespace flexarm {

/// Of another scene with the settings of `like`, at its start, which is not its equilibrium. @throws ModelError
Simulation with_settings_of(const Simulation& like, scene::SceneDescription scene);
/// Adds to a state of the simulation's model what its scheme keeps at the beginning of a motion.
/// @throws std::invalid_argument where that cannot be found
void begin(Simulation& simulation, State& state);

/// How a change counts in the account of energy.
enum class EnergyChange {
  Work,       ///< what comes or goes has its own
  Dissipated  ///< nothing comes or goes: what is missing was lost
};

/// Makes the simulation one of `scene` in which all that has kept its name goes on from `state`, one of the simulation.
/// `touched`: links whose accelerations have jumped, as have those of the mechanisms to which they belong.
/// @throws ModelError; std::invalid_argument where the mesh of a flexible link would be another one. The simulation is
/// as before then.
void go_on_with(Simulation& simulation, const State& state, const scene::SceneDescription& scene,
                const std::set<std::string>& touched, EnergyChange change);

}  // namespace flexarm
