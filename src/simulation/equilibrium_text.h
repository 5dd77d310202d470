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

/// Load steps that lead to most equilibria.
constexpr int kLoadSteps = 10;

/// Whether a few modes take seconds and no more: without springs, there is a free one for every joint coordinate.
bool are_modes_quick(std::size_t unknowns, std::size_t coordinates);

/// Why solve_static() failed with `result`: by what nothing holds, if that is it. `modes` about the initial
/// configuration: of all free motions; or none.
std::string lack_of_equilibrium(const scene::SceneDescription& scene, const Model& model, const StepResult& result,
                                const std::vector<Mode>& modes);
/// The same of a simulation, which is as before solve_static(): looks for these modes where that is quick.
std::string lack_of_equilibrium(const Simulation& simulation, const StepResult& result);

/// That an equilibrium is not stable, or not the only one, or known to a few digits; empty if none of these.
/// `consequence`: what becomes of the link that falls.
std::vector<std::string> doubts_about_equilibrium(const Model& model, double contact_time, const State& equilibrium,
                                                  const StaticResult& result, const std::string& consequence);
/// The same of a simulation, which is in that equilibrium.
std::vector<std::string> doubts_about_equilibrium(const Simulation& simulation, const StaticResult& result,
                                                  const std::string& consequence);

}  // namespace flexarm
