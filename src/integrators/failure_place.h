#pragma once
/// Finds the place in the mechanism where a step failed.

#include "flexarm/model/results.h"
#include "integrators/step_system.h"

namespace flexarm {

/// Completes `result.failure` by what the last attempt at the step has left in `system`, and names a cause where the
/// reason is only that the iteration did not converge. Takes its time, and allocates where there are loops.
void locate_failure(const StepSystem& system, StepResult& result);

}  // namespace flexarm
