#pragma once
/// Estimates the error of a simulation while it runs. (docs/notes/accuracy.md 6)

#include <limits>
#include <memory>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Runs beside a simulation with steps of twice the length, under the same commands. The distance between the judged
/// points of both tells the error. This costs half as much time again. After its construction it allocates memory only
/// when the simulation does.
class Companion {
 public:
  /// `window`: after that time it starts again from the state of the simulation, so that old errors do not count [s];
  /// infinite: never.
  /// @throws std::invalid_argument if the window is not > 0, or steps of twice the length do not divide the sample time
  /// of a servo.
  explicit Companion(const Simulation& simulation, double window = std::numeric_limits<double>::infinity());

  ~Companion();
  Companion(Companion&&) noexcept;
  Companion& operator=(Companion&&) noexcept;

  /// Call it after each step of the simulation, before the next commands. Returns the largest estimated error of a
  /// position since the window began, or in the window before if that is larger [m]; NaN before the second step. If
  /// forces jump within steps (stops, dry friction, play, limits, functions of time) both simulations may have the same
  /// error: two steps later the estimate includes a bound of it; it is NaN if the bound is not known, as in the first
  /// three steps.
  double follow(const Simulation& simulation);
  /// Starts again from the simulation's state. Call it after that was changed.
  void begin(const Simulation& simulation);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
