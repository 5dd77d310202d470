#pragma once
/// The balance of a step.

#include "solver/reduced_residual.h"

namespace flexarm {

/// Where the parts of a step put what they contribute.
struct Balance {
  ReducedResidual& residual;
  TangentBackend* tangent;  ///< null where only the residual is asked for
  /// What carried stresses would add to the residual, for the geometric parts of the tangent; null: nothing.
  ReducedResidual* carried = nullptr;
  double dissipated = 0;  ///< energy that has left over the step [J]
};

}  // namespace flexarm
