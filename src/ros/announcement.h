#pragma once
/// What the node says when it begins with a scene.

#include <string>

#include "flexarm/simulation/simulation.h"
#include "run_state.h"

namespace flexarm::node {

/// Logs two lines: the scene with its joints and unknowns; how it is stepped, and in which namespaces topics and
/// services are. Before these what is doubtful about the model, as `flexarm check` does.
void say_what_is_simulated(const Simulation& simulation, const RunState& run, const std::string& topics,
                           const std::string& services);

}  // namespace flexarm::node
