#pragma once
/// Forces over the last steps, for output.

#include <array>
#include <cstddef>
#include <vector>

namespace flexarm {

/// Forces averaged over whole steps: what drives motions, what joints transmit. Where a fast mode or a prescribed
/// coordinate's own velocity flips its sign from step to step, so do they; what is put out is free of that and belongs
/// to the end of a step (theory.md, "Published velocities and efforts").
struct StepMeans {
  static constexpr int kLength = 3;
  std::vector<double> impulse;                     ///< of the step under way [N s or N m s]
  std::array<std::vector<double>, kLength> means;  ///< newest first [N or N m]
  std::array<double, kLength> durations{};         ///< of the steps over which they were taken [s]
  int count = 0;                                   ///< of means that hold

  void resize(std::size_t forces);
  /// A whole step begins.
  void begin();
  /// It has ended, after `duration` [s].
  void end(double duration);
  /// Nothing before counts: these are the forces [N or N m].
  void restart(const std::vector<double>& forces);
  /// A force at the end of the last step, of second order from the third step on [N or N m].
  double at_end(std::size_t force) const;
};

}  // namespace flexarm
