#pragma once
/// What all subcommands do with their input.

#include <string>

#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// Reads a scene and builds its simulation; findings go to the standard error output.
/// @throws InputError if the scene has errors, ModelError if it cannot be built.
Simulation load_simulation(const std::string& scene, const SimulationOptions& options = {});

/// For options: a finite number > 0, or >= 0.
std::string check_positive(const std::string& text);
std::string check_non_negative(const std::string& text);

/// Goes to the equilibrium if there is one that can be found, and says so if not: a free body has none.
void seek_equilibrium(Simulation& simulation);

}  // namespace flexarm::cli
