#include "joints/joint_forces.h"

#include <cmath>

namespace flexarm {

double smooth_friction(double rate) {
  return std::tanh(rate / kFrictionSpeed);
}

SmoothDirection smooth_direction(const CoordinateStep& change) {
  if (change.step == 0) return {};
  const double t = smooth_friction(rate_of(change));
  return {t, (1 - t * t) / kFrictionSpeed * rate_slope(change)};
}

FrictionRise friction_rise(const Coordinate& coordinate, const CoordinateStep& change) {
  if (coordinate.static_ratio == 1 || change.step == 0) return {};
  const double x = rate_of(change) / coordinate.stribeck_speed;
  const double rise = (coordinate.static_ratio - 1) * std::exp(-x * x);
  return {1 + rise, -2 * x * rise / coordinate.stribeck_speed * rate_slope(change)};
}

bool is_coarse_turn(double begin_rate, double end_rate, double refinement) {
  constexpr double kLargestTurn = 0.5;
  return refinement * std::abs(smooth_friction(end_rate) - smooth_friction(begin_rate)) > kLargestTurn;
}

PassiveEffort passive_effort(const Coordinate& coordinate, const CoordinateStep& change) {
  PassiveEffort out;
  const double friction = coordinate.sticks ? 0 : coordinate.friction;
  if (change.step != 0 && (coordinate.damping > 0 || friction > 0)) {
    const SmoothDirection direction = smooth_direction(change);
    const FrictionRise rise = friction_rise(coordinate, change);
    out.effort = -coordinate.damping * rate_of(change) - friction * rise.value * direction.value;
    out.slope = -(coordinate.damping * rate_slope(change) +
                  friction * (rise.value * direction.slope + rise.slope * direction.value));
    out.dissipated = -out.effort * change.increment;
  }
  if (coordinate.limit) {
    const PassiveEffort stop = stop_effort(*coordinate.limit, change);
    out.effort += stop.effort;
    out.slope += stop.slope;
    out.dissipated += stop.dissipated;
  }
  return out;
}

}  // namespace flexarm
