#pragma once
/// Input and output of efforts on a released coordinate over a step.

#include <cassert>

namespace flexarm {

/// Which law one side of a stop follows over a step. Simulations choose it by the penetration. Derivatives of a run
/// keep the law that the run had, even if a small variation would change it.
enum class StopContact : char {
  ByDepth,  ///< pushes if it is penetrated; never pulls
  Off,      ///< no effort
  On        ///< spring and damper act, whatever the signs of penetration and effort
};

/// The change of a coordinate over a step, and the rule for its rate:
/// rate = (increment / step - (1 - gamma) begin_rate) / gamma; gamma = 1 gives the mean rate of conserving schemes.
struct CoordinateStep {
  double begin = 0, end = 0;  ///< positions
  double increment = 0;       ///< end - begin, or a component of a tangent-scaled rotation increment
  double step = 0;            ///< length of the step [s]; 0: statics (no damping, no friction)
  double gamma = 1, begin_rate = 0;
  bool at_end = false;  ///< efforts are those at the end of the step; else means over it, with exact work
  /// With `at_end`: steps of this length [s] do not find where stops are touched, and spread what jumps there (see
  /// stop_effort()). 0: the laws as they are at an instant.
  double blur = 0;
  StopContact below = StopContact::ByDepth, above = StopContact::ByDepth;
};

/// Returns the rate on which damping and smooth friction depend. Not for statics.
inline double rate_of(const CoordinateStep& change) {
  assert(change.step != 0 && change.gamma != 0 && "nothing has a rate in statics");
  return (change.increment / change.step - (1 - change.gamma) * change.begin_rate) / change.gamma;
}
/// Returns the derivative of rate_of() with respect to the increment.
inline double rate_slope(const CoordinateStep& change) {
  assert(change.step != 0 && change.gamma != 0 && "nothing has a rate in statics");
  return 1 / (change.gamma * change.step);
}

/// An effort on a coordinate, its derivative with respect to the increment, and the energy that it dissipates over the
/// step [J].
struct PassiveEffort {
  double effort = 0, slope = 0, dissipated = 0;
};

}  // namespace flexarm
