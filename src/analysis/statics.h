#pragma once
/// Equilibria under gravity and loads.

#include <vector>

#include "flexarm/model/results.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Equilibrium by `load_steps` equal increments of gravity and loads, halved where Newton's method asks for it; with
/// the scheme's interpolation. Prescribed motions are held at time 0, other released coordinates are solved for. On
/// success `state` is at rest there; on failure it is untouched. `update_norms`: those of the last solve.
StepResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                        State& state, std::vector<double>* update_norms = nullptr);

}  // namespace flexarm
