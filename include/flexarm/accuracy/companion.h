#pragma once
/// The error of a simulation that runs in steps of its own choice, while it runs. (docs/notes/accuracy.md 6)

#include <limits>
#include <memory>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Runs beside a simulation with steps of twice the length, under the same commands. How far the judged points are from
/// those of the simulation says how large its error is; that costs half as much again. Allocates nothing after its
/// construction, but where the simulation does.
class Companion {
 public:
  /// `window`: after that long it starts again from where the simulation is, so that errors of long ago do not count;
  /// infinite: it never does [s].
  /// @throws std::invalid_argument if the window is not > 0, or steps of twice the length do not divide the sample time
  /// of a servo.
  explicit Companion(const Simulation& simulation, double window = std::numeric_limits<double>::infinity());

  ~Companion();
  Companion(Companion&&) noexcept;
  Companion& operator=(Companion&&) noexcept;

  /// After each step of the simulation, before it is commanded anew. Returns the largest estimate of the error of a
  /// position since the window began, or in the one before if that is larger [m]; NaN before the second step. Where
  /// forces jump within steps (stops, dry friction, play, limits, functions of time) both simulations may err alike:
  /// what that may come to is in it, two steps later; NaN where it is not known, as it was within the first three.
  double follow(const Simulation& simulation);
  /// The simulation has been put elsewhere: starts again from there.
  void begin(const Simulation& simulation);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
