#pragma once
/// The residual and tangent of a step, while the parts of the step add to them.

#include "solver/reduced_residual.h"

namespace flexarm {

template <int Nodes>
struct BeamElement;
template <int Nodes>
struct ElementSystem;

/// The targets to which the parts of a step add their contributions.
struct Balance {
  ReducedResidual& residual;
  TangentBackend* tangent;  ///< null if only the residual is evaluated
  /// Difference that carried stresses would make to the residual; the geometric parts of the tangent use it
  /// (docs/notes/newton.md). Null: no stresses are carried.
  ReducedResidual* carried = nullptr;
  double dissipated = 0;  ///< energy dissipated over the step [J]

  /// Adds an element's system. `is_first`: whether this is the first system of this element that is added.
  template <int Nodes>
  void add(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, bool is_first);
};

}  // namespace flexarm
