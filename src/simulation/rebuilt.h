#pragma once
/// Replaces a simulation by one of an edited scene, in which the motion goes on: links were added or removed.

#include <set>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "model/state.h"

namespace flexarm {

/// Makes a simulation of another scene with the settings of `like`. It is at its start, and does not search for an
/// equilibrium.
/// @throws ModelError if the scene cannot be built
Simulation with_settings_of(const Simulation& like, scene::SceneDescription scene);
/// Adds to a state of the simulation's model what its scheme stores at the beginning of a motion, such as
/// accelerations.
/// @throws std::invalid_argument if these cannot be found
void begin(Simulation& simulation, State& state);

/// How the change of energy counts in the energy account.
enum class EnergyChange {
  Work,       ///< links come or go, with their energy
  Dissipated  ///< no link comes or goes: the missing energy was lost
};

/// Replaces the simulation by one of `scene`. Whatever has kept its name goes on from `state`, which is a state of the
/// old simulation. `touched`: links whose accelerations jump, together with those of the mechanisms to which they
/// belong.
/// @throws ModelError; std::invalid_argument if a flexible link would get another mesh. Then the simulation stays as it
/// is.
void go_on_with(Simulation& simulation, const State& state, const scene::SceneDescription& scene,
                const std::set<std::string>& touched, EnergyChange change);

}  // namespace flexarm
