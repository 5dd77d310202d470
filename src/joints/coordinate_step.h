#pragma once
/// The motion of a released coordinate over a step, as an effort on it sees it, and what the effort does.

#include <cassert>

namespace flexarm {

/// Which law of one side of a stop holds over a step. Runs have it by the penetration; derivatives of runs hold the law
/// that the run has, also a little beside the place where it ends.
enum class StopContact : char {
  ByDepth,  ///< pushes where it is penetrated, and does not pull
  Off,      ///< does nothing
  On        ///< spring and damper act, whatever their sign
};

/// Change of a coordinate over a step, and how its rate is formed:
/// rate = (increment / step - (1 - gamma) begin_rate) / gamma; gamma = 1 gives the mean rate of conserving schemes.
struct CoordinateStep {
  double begin = 0, end = 0;  ///< positions
  double increment = 0;       ///< end - begin, or a component of a tangent-scaled rotation increment
  double step = 0;            ///< [s]; 0: statics (no damping, no friction)
  double gamma = 1, begin_rate = 0;
  bool at_end = false;  ///< efforts are those at the end of the step; else means over it, whose work is exact
  StopContact below = StopContact::ByDepth, above = StopContact::ByDepth;
};

/// The rate that damping and smooth friction feel. Not in statics.
inline double rate_of(const CoordinateStep& change) {
  assert(change.step != 0 && change.gamma != 0 && "nothing has a rate in statics");
  return (change.increment / change.step - (1 - change.gamma) * change.begin_rate) / change.gamma;
}
/// Its derivative with respect to the increment.
inline double rate_slope(const CoordinateStep& change) {
  assert(change.step != 0 && change.gamma != 0 && "nothing has a rate in statics");
  return 1 / (change.gamma * change.step);
}

/// Effort on the coordinate, its derivative with respect to the increment, and the energy that it dissipates over the
/// step.
struct PassiveEffort {
  double effort = 0, slope = 0, dissipated = 0;
};

}  // namespace flexarm
