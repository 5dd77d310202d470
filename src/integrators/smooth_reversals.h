#pragma once
/// Helps Newton's method where smooth friction reverses its direction within a step.

#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// Far from zero, tanh has no slope, so that Newton's method jumps back and forth between its two sides. So an update
/// that would reverse the rate stops at rate zero instead. From there, the method approaches the solution without
/// passing it, because tanh is concave. This is done only a few times in a solve. Otherwise the joints of a loop could
/// hold each other at zero in turns, as could oscillating rates of the Newmark family.
class SmoothReversals {
 public:
  explicit SmoothReversals(StepConfiguration& configuration);

  void begin() { updates_ = 0; }
  void before_update();
  void after_update();
  /// Whether the step is too long for a reversal that lies in it.
  bool turn_too_fast(double refinement);

 private:
  double rate(int coordinate) const;

  StepConfiguration& configuration_;
  std::vector<int> coordinates_;  // coordinates with smooth friction and an unknown of their own
  std::vector<double> rates_;     // before the update
  int updates_ = 0;               // number of updates in this attempt
};

}  // namespace flexarm
