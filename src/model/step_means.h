#pragma once
/// Computes output forces from their means over the last steps.

#include <array>
#include <cstddef>
#include <vector>

namespace flexarm {

/// Forces averaged over whole steps: efforts that drive motions, and wrenches that joints transmit. These means
/// alternate from step to step if a fast mode or the velocity of a prescribed coordinate does. The output, at_end(),
/// has no such part, and is the value at the end of a step (theory.md, "Published velocities and efforts").
struct StepMeans {
  static constexpr int kLength = 3;
  std::vector<double> impulse;                     ///< of the current step so far [N s or N m s]
  std::array<std::vector<double>, kLength> means;  ///< of the last steps, newest first [N or N m]
  std::array<double, kLength> durations{};         ///< of these steps [s]
  int count = 0;                                   ///< number of valid means

  void resize(std::size_t forces);
  /// Call this when a whole step begins.
  void begin();
  /// Call this when the whole step has ended. `duration`: its length [s].
  void end(double duration);
  /// Forgets all means, and the impulse of the current step so far: the forces jump, or have struck.
  void begin_anew();
  /// Forgets all means; `forces` are the forces at this instant [N or N m].
  void restart(const std::vector<double>& forces);
  /// Returns a force at the end of the last step [N or N m]. It is accurate to second order from the third step on.
  double at_end(std::size_t force) const;
};

}  // namespace flexarm
