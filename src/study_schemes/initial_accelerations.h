#pragma once
/// The accelerations from which Newmark's family starts.

#include "flexarm/model/results.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Sets the accelerations of a state from a short momentum-conserving step. `of_step`: settings of the steps to come.
/// @returns the result of that step; if it failed, accelerations are zero
StepResult find_accelerations(const Model& model, const StepSettings& of_step, State& state);

}  // namespace flexarm
