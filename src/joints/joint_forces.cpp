#include "joints/joint_forces.h"

#include <cmath>

namespace flexarm {

SmoothDirection smooth_direction(const CoordinateStep& change) {
  if (change.step == 0) return {};
  const double t = std::tanh(rate_of(change) / kFrictionSpeed);
  return {t, (1 - t * t) / kFrictionSpeed * rate_slope(change)};
}

bool is_coarse_turn(double begin_rate, double end_rate, double refinement) {
  constexpr double kLargestTurn = 0.5;
  return refinement * std::abs(std::tanh(end_rate / kFrictionSpeed) - std::tanh(begin_rate / kFrictionSpeed)) >
         kLargestTurn;
}

PassiveEffort passive_effort(const Coordinate& coordinate, const StopPenalty& penalty, const CoordinateStep& change) {
  PassiveEffort out;
  const double friction = coordinate.sticks ? 0 : coordinate.friction;
  if (change.step != 0 && (coordinate.damping > 0 || friction > 0)) {
    const SmoothDirection direction = smooth_direction(change);
    out.effort = -coordinate.damping * rate_of(change) - friction * direction.value;
    out.slope = -(coordinate.damping * rate_slope(change) + friction * direction.slope);
    out.dissipated = -out.effort * change.increment;
  }
  if (coordinate.limit) {
    const PassiveEffort stop = stop_effort(*coordinate.limit, penalty, change);
    out.effort += stop.effort;
    out.slope += stop.slope;
    out.dissipated += stop.dissipated;
  }
  return out;
}

}  // namespace flexarm
