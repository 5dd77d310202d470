#pragma once
/// Meshes of beams with elements="auto", for `flexarm simulate --accuracy`.

#include "cli/simulation_output.h"

namespace flexarm::cli {

struct ChosenMeshes {
  double left;       ///< of the accuracy, for the steps
  double error = 0;  ///< of the meshes, as estimated, relative
  bool is_met = true;
};

/// Where beams ask for elements="auto", makes the simulation one whose meshes are chosen for the accuracy; says so on
/// the report's stream, and on the standard error output where they do not keep it. Nothing changes where a state is
/// read or kept: it is one of the scene's own meshes.
ChosenMeshes choose_meshes(const SimulateArguments& arguments, double accuracy, Simulation& simulation);

}  // namespace flexarm::cli
