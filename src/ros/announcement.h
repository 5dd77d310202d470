#pragma once
/// The log messages with which the node introduces a scene, at its start and after each new scene.

#include <string>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// Logs the warnings about the model that `flexarm check` gives, then two lines. The first names the scene, its joints
/// and the number of unknowns. The second names scheme and step, and the namespaces of topics and services.
void say_what_is_simulated(const Simulation& simulation, const RunState& run, const std::string& topics,
                           const std::string& services);

/// Logs a line, if there is reason to, as the table of `flexarm check` of joints at the ends of beams: by how much
/// controllers may damp them. For large models it takes some tenths of a second.
void advise_controllers(const Simulation& simulation);

}  // namespace flexarm::node
