#pragma once
/// Equilibria under gravity and loads.

#include "flexarm/model/results.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Equilibrium by `load_steps` equal increments of gravity and loads, halved where Newton's method asks for it; with
/// the scheme's interpolation. Prescribed motions are held at time 0, other released coordinates are solved for. On
/// success `state` is at rest there; on failure it is untouched.
StepResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                        State& state);

}  // namespace flexarm
