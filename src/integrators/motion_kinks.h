#pragma once
/// Jumps of the rates of prescribed motions, in schemes that would carry half of them on for ever.
/// (docs/theory/time_integration.md, "Motions whose rate jumps")

#include <vector>

#include "joints/joint_kinematics.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// With the rule v1 = 2 dx/h - v0, rates alternate about the true ones after the rate of a prescribed motion has
/// jumped. Two very short sub-steps bring a prescribed coordinate from the rate v0 to the rate v2 and to the position
/// x2 that its function has after them, if it is led to x1 = (x0 + x2)/2 - h (v2 - v0)/4 between them. The rest of the
/// mechanism feels the impulse. Allocates no memory after construction.
class MotionKinks {
 public:
  MotionKinks(const Model& model, const Scheme& scheme);

  /// Length of each of the two sub-steps, relative to the whole step.
  static constexpr double kShort = 1.0 / 8192;

  /// Whether rates of motions differ from those of their functions more than the scheme explains, at the beginning of a
  /// step of length `step` [s].
  bool found(const State& state, double step);
  /// Per coordinate: its position x1 after the first sub-step; NaN where it follows its function.
  const std::vector<double>& places() const { return places_; }
  /// Lets all coordinates follow their functions in the second sub-step.
  void let_go();

 private:
  const Model& model_;
  std::vector<int> led_;  // coordinates with motions that may have kinks
  std::vector<double> places_;
  StateRates rate_;
};

}  // namespace flexarm
