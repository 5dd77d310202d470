#pragma once
/// Shows what does not move: natural modes, and equilibria.

#include <string>
#include <vector>

#include "pictures/recording.h"

namespace flexarm::pictures {

/// A mode with its name for the user.
struct NamedMode {
  std::string name;
  Mode mode;
};

/// Records the present configuration, faintly beside all others, and then each mode as a clip: one period of two
/// seconds, with an amplitude that is seen well. Growth and decay are not shown.
EncodedRun record_modes(const Simulation& simulation, const std::vector<NamedMode>& modes, const std::string& title);

/// Records the scene's start, faintly beside the equilibrium. If the two hardly differ, there is a second clip in which
/// ways and turns from the start are a number of times as large, with strains and columns of the equilibrium.
/// @param start, equilibrium  the same simulation, before and after Simulation::solve_static()
EncodedRun record_equilibrium(const Simulation& start, const Simulation& equilibrium);

}  // namespace flexarm::pictures
