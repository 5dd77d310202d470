#pragma once
/// Settings of Newton's method, of the step control, and of the search for events.

#include <cstdint>

#include "flexarm/schemes/integrator_description.h"

namespace flexarm {

/// Settings of the search for events within steps, at which the equations change: friction stops a coordinate or
/// changes its direction, a stop or a body is touched or left, a gear enters or leaves its play, a slider reaches the
/// end of its line, a motor reaches its limit. (docs/notes/accuracy.md 4)
struct EventSearch {
  /// If an event lies within a step, and farther than this from both ends, the step is not done. It returns
  /// StepResult::Reason::EventWithin, and Stepper::event() gives the time of the event [s]. 0: steps ignore events.
  double tolerance = 0;
  /// Stops by friction do not count as events within this time from the beginning of a step [s].
  double slide = 0;
  /// Factor >= 1 by which steps are shorter in hits on stops. If it is above 1, reversals of smooth friction are
  /// resolved by shorter steps, too.
  double refinement = 1;
  /// Whether a hit is going on. Its steps are so short that they need not be halved for kinks at unknown times.
  bool is_in_hit = false;

  bool is_on() const { return tolerance > 0; }
  bool operator==(const EventSearch& other) const {
    return tolerance == other.tolerance && slide == other.slide && refinement == other.refinement &&
           is_in_hit == other.is_in_hit;
  }
};

/// Settings of Newton's method and of the step control.
struct StepSettings {
  double step = 1e-3;       ///< [s]
  double tolerance = 1e-8;  ///< for the largest update: displacement / model's length scale, or rotation [rad]
  int max_iterations = 20;
  int max_halvings = 14;  ///< except for hits on stops, see finest_halving()
  EventSearch events;
  /// Reuse a factorisation of the tangent while the iteration converges well (modified Newton). The result differs from
  /// that of full Newton by far less than the tolerance. If off, convergence is quadratic, and a run that continues
  /// from a restored state is the same bit for bit.
  bool reuse_factorisation = true;
  OnFailure on_failure = OnFailure::Stop;
  /// Time limit of wall time [s]; 0: none. A step that had to be halved is aborted after this time. The last Newton
  /// iteration may take longer. A step that another scheme repeats (OnFailure::Dissipate) has the remaining time.
  double recovery_wall_time = 0;
};

/// Maximal number of halvings of a step. Hits on stops need more of them the faster they are. 0 if the settings allow
/// no halving.
inline int finest_halving(const StepSettings& settings) {
  constexpr int kFinestAtStops = 40;
  return settings.max_halvings > 0 ? kFinestAtStops : 0;
}

/// Number of shortest sub-steps in a step that may be halved `halvings` times, at most 62.
constexpr std::int64_t parts_of_step(int halvings) {
  return std::int64_t{1} << halvings;  // a long has 32 bits on some systems
}

}  // namespace flexarm
