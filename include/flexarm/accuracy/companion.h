#pragma once
/// Estimates the error of a simulation while it runs. (docs/notes/accuracy.md 6)

#include <limits>
#include <memory>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Runs a second simulation beside the first one, with steps of twice the length and the same commands. The distance
/// between the judged points of the two simulations yields an error estimate. This adds half of the computing time.
/// After its construction a companion allocates memory only when the simulation does.
class Companion {
 public:
  /// `window`: interval after which the companion restarts from the state of the simulation, so that old errors do not
  /// count [s]; infinite: it never restarts.
  /// @throws std::invalid_argument if the window is not > 0, or if the sample time of a servo is not a multiple of
  /// twice the step.
  explicit Companion(const Simulation& simulation, double window = std::numeric_limits<double>::infinity());

  ~Companion();
  Companion(Companion&&) noexcept;
  Companion& operator=(Companion&&) noexcept;

  /// Call this after each step of the simulation, before the next commands. Returns the largest estimated error of a
  /// position in the present window or, if larger, in the window before [m]. NaN before the second step. If forces jump
  /// within steps (stops, dry friction, play, limits, functions of time), both simulations may have the same error. Two
  /// steps later the estimate includes a bound of that error. The estimate is NaN if the bound is not known, as in the
  /// first three steps.
  double follow(const Simulation& simulation);
  /// Restarts from the simulation's state. Call this after the state was changed by other means than a step.
  void begin(const Simulation& simulation);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
