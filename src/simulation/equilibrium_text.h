#pragma once
/// Messages about an equilibrium, or about why there is none.

#include <string>
#include <vector>

#include "flexarm/model/results.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Number of load steps that is enough for most equilibria.
constexpr int kLoadSteps = 10;

/// Whether all free modes can be computed in seconds. Without springs, each joint coordinate may have one.
bool are_modes_quick(std::size_t unknowns, std::size_t coordinates);

/// Says why solve_static() failed with `result`. If nothing holds some joints, it names them. `modes`: all free modes
/// about the initial configuration, or an empty list if they are not known.
std::string lack_of_equilibrium(const scene::SceneDescription& scene, const Model& model, const StepResult& result,
                                const std::vector<Mode>& modes);
/// The same for a simulation whose state is as before solve_static(). Computes the free modes if that is quick.
std::string lack_of_equilibrium(const Simulation& simulation, const StepResult& result);

/// Says whether an equilibrium is unstable, not the only one, or known to a few digits only. Empty if none of these
/// holds. `consequence`: words for what happens to the link that falls.
std::vector<std::string> doubts_about_equilibrium(const Model& model, const State& equilibrium,
                                                  const StaticResult& result, const std::string& consequence);
/// The same for a simulation that is in that equilibrium.
std::vector<std::string> doubts_about_equilibrium(const Simulation& simulation, const StaticResult& result,
                                                  const std::string& consequence);

}  // namespace flexarm
