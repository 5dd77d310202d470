#pragma once
/// What is asked of a step.

#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

/// Settings of Newton's method and of the step control.
struct StepSettings {
  double step = 1e-3;       ///< [s]
  double tolerance = 1e-8;  ///< on the largest update: displacements over the model's length scale, rotations in rad
  int max_iterations = 20;
  int max_halvings = 14;  ///< but where a stop is hit, see finest_halving()
  /// Halvings of a step within which friction sticks or slips anew, a stop is touched or left, or a slider comes to its
  /// end, within max_halvings. 0: steps go over such events.
  int event_halvings = 0;
  /// Keep the factors of the tangent while the iteration contracts well (modified Newton). The result agrees with that
  /// of full Newton to far below the tolerance; off: quadratic convergence, and a restored state continues bit for bit.
  bool reuse_factorisation = true;
  OnFailure on_failure = OnFailure::Stop;
  /// By the clock on the wall [s], after which a step that has been halved is given up, however far it has come; 0:
  /// never. What one Newton iteration takes comes on top.
  double recovery_wall_time = 0;
};

/// Halvings of a step at most: a hit on a stop asks for as many as it is fast, of which there is no bound but this one;
/// where nothing is to be halved, stops are no exception.
inline int finest_halving(const StepSettings& settings) {
  constexpr int kFinestAtStops = 40;
  return settings.max_halvings > 0 ? kFinestAtStops : 0;
}

}  // namespace flexarm
