#pragma once
/// Reversals of smooth friction, between Newton's iterations.

#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// Newton's method for tanh jumps to and fro between both ends, where it has no slope. An update that would reverse the
/// rate stops at rate zero instead: from there, and from any smaller rate than the solution's, the method goes on to it
/// without passing it, because tanh is concave. Only a few times: joints of a loop, or in the Newmark family, whose
/// rates ring, can hold each other there in turns.
class SmoothReversals {
 public:
  explicit SmoothReversals(StepConfiguration& configuration);

  void begin() { updates_ = 0; }
  void before_update();
  void after_update();
  /// True where so long a step goes through much of a reversal.
  bool turn_too_fast(double refinement);

 private:
  double rate(int coordinate) const;

  StepConfiguration& configuration_;
  std::vector<int> coordinates_;  // with an unknown of their own and smooth friction
  std::vector<double> rates_;     // before the update
  int updates_ = 0;               // of this trial
};

}  // namespace flexarm
