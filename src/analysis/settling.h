#pragma once
/// Lets a mechanism settle in an equilibrium.

#include "integrators/newton.h"

namespace flexarm {

/// Lets a mechanism sink to an equilibrium, as if through a fluid that is so thick that nothing has inertia: in
/// implicit Euler steps, longer and longer ones as it comes to rest, until they are Newton's. Such a motion ends in
/// stable equilibria alone where loads have a potential, and needs no stiffness to start with.
class Settling {
 public:
  /// `neutral`: curvature of the potential that counts as none, see Stability; drag is never less, so that round-off of
  /// the balance does not move what nothing holds [J]. `tolerance`: on ways. The system and the iteration must outlive
  /// it.
  Settling(StepSystem& system, NewtonIteration& newton, double neutral, double tolerance)
      : system_(system), newton_(newton), neutral_(neutral), tolerance_(tolerance) {}

  /// Settles from `state`, under loads times `load_factor`; forces decide the steps. Returns false if it does not come
  /// to rest, or if stiffness cannot balance what moves it; then `result` says why, and `state` is where it was given
  /// up.
  bool settle(State& state, double load_factor, StepResult& result);
  /// The same with the first step's Drag::strength.
  bool settle(State& state, double load_factor, double drag, StepResult& result);

 private:
  StepSystem& system_;
  NewtonIteration& newton_;
  double neutral_, tolerance_;
};

}  // namespace flexarm
