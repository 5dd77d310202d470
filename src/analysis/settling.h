#pragma once
/// Finds an equilibrium by letting a mechanism settle.

#include "integrators/newton.h"

namespace flexarm {

/// Lets a mechanism sink to an equilibrium, as if through a thick fluid, without inertia. It makes implicit Euler
/// steps, which become longer as the mechanism comes to rest, until they are Newton's steps. If loads have a potential,
/// such a motion ends in a stable equilibrium only. It needs no stiffness at the start.
class Settling {
 public:
  /// `neutral`: curvature of the potential that counts as zero, see neutral_curvature() [J]. The drag is never less, so
  /// that round-off of the balance does not move what nothing holds. `tolerance`: for the length of steps. `model`,
  /// `system` and `newton` must outlive this object.
  Settling(const Model& model, StepSystem& system, NewtonIteration& newton, double neutral, double tolerance)
      : model_(model), system_(system), newton_(newton), neutral_(neutral), tolerance_(tolerance) {}

  /// Settles from `state`, under loads times `load_factor`. The drag of the first step follows from the forces. Returns
  /// false if the mechanism does not come to rest. Then `result` says why, and `state` is where the search was given
  /// up. If the loads move the mechanism without limit, the place of the failure is the link that moves most.
  bool settle(State& state, double load_factor, StepResult& result);
  /// The same, with a given Drag::strength in the first step.
  bool settle(State& state, double load_factor, double drag, StepResult& result);

 private:
  const Model& model_;
  StepSystem& system_;
  NewtonIteration& newton_;
  double neutral_, tolerance_;
};

}  // namespace flexarm
