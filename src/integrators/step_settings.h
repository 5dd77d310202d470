#pragma once
/// The settings of a step.

#include <cstdint>

#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

/// How steps look for events, at which the equations change: friction stops a coordinate or turns its direction, a stop
/// is touched or left, the play of a gear begins or ends, a slider comes to its end, a motor to its limit.
/// (docs/notes/accuracy.md 4)
struct EventSearch {
  /// A step within which an event happens farther than this from both of its ends is not done: it ends as
  /// StepResult::Reason::EventWithin, and Stepper::event() says when [s]. 0: steps go over events.
  double tolerance = 0;
  /// Friction may stop sliding within this time from the beginning of a step [s].
  double slide = 0;
  /// Factor >= 1 by which hits on stops are resolved finer than usual. If it is above 1, reversals of smooth friction
  /// are resolved, too.
  double refinement = 1;

  bool is_on() const { return tolerance > 0; }
  bool operator==(const EventSearch& other) const {
    return tolerance == other.tolerance && slide == other.slide && refinement == other.refinement;
  }
};

/// Settings of Newton's method and of the step control.
struct StepSettings {
  double step = 1e-3;       ///< [s]
  double tolerance = 1e-8;  ///< on the largest update: displacements over the model's length scale, rotations in rad
  int max_iterations = 20;
  int max_halvings = 14;  ///< but where a stop is hit, see finest_halving()
  EventSearch events;
  /// Keep the factors of the tangent while the iteration contracts well (modified Newton). The result agrees with that
  /// of full Newton to far below the tolerance; off: quadratic convergence, and a restored state continues bit for bit.
  bool reuse_factorisation = true;
  OnFailure on_failure = OnFailure::Stop;
  /// Wall time after which a step that had to be halved is given up, however far it has come [s]; 0: never. The last
  /// Newton iteration may take longer. A step that another scheme repeats (OnFailure::Dissipate) has the time that is
  /// left.
  double recovery_wall_time = 0;
};

/// Halvings of a step at most: a hit on a stop asks for as many as it is fast, of which there is no bound but this one;
/// where nothing is to be halved, stops are no exception.
inline int finest_halving(const StepSettings& settings) {
  constexpr int kFinestAtStops = 40;
  return settings.max_halvings > 0 ? kFinestAtStops : 0;
}

/// The shortest sub-steps in a step that may be halved so often, up to 62 times: they count how far it has come.
constexpr std::int64_t parts_of_step(int halvings) {
  return std::int64_t{1} << halvings;  // a long has 32 bits on some systems
}

}  // namespace flexarm
