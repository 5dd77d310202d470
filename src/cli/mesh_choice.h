#pragma once
/// Meshes of beams with elements="auto", for `flexarm simulate --accuracy`.

#include "cli/simulation_output.h"

namespace flexarm::cli {

/// Where beams ask for elements="auto", makes the simulation one whose meshes are chosen for the accuracy; says so on
/// the report's stream, and on the standard error output where they do not keep it. Returns what of the accuracy is
/// left for the steps. Nothing changes where a state is read or kept: it is one of the scene's own meshes.
double choose_meshes(const SimulateArguments& arguments, double accuracy, Simulation& simulation, bool& is_met);

}  // namespace flexarm::cli
