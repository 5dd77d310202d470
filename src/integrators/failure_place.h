#pragma once
/// Finds the place in the mechanism where a step failed.

#include "flexarm/model/results.h"
#include "integrators/step_system.h"

namespace flexarm {

/// Completes `result.failure` with what the last attempt at the step has left in `system`. Replaces a failed iteration
/// as the reason by a more specific one, if there is one. Slow; allocates memory if there are loops.
void locate_failure(const StepSystem& system, StepResult& result);

}  // namespace flexarm
