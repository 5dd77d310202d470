#include "joints/joint_forces.h"

#include <algorithm>
#include <cmath>

#include "math/pi.h"

namespace flexarm {
namespace {

/// Ratio of a stop's damping to the critical one. A contact that never pulls ends where its force vanishes, after which
/// the speed is e = exp(-2 z acos(z) / sqrt(1 - z^2)) of that before: 0.3.
constexpr double kStopDampingRatio = 0.497239;

/// One-sided stop with gap phi >= 0 free; effort along increasing gap.
PassiveEffort stop_effort(const StopPenalty& penalty, double gap_begin, double gap_end, double step) {
  const double k = penalty.stiffness;
  const double p0 = std::min(gap_begin, 0.0), p1 = std::min(gap_end, 0.0);
  if (p0 == 0 && p1 == 0) return {};
  PassiveEffort out;
  if (step == 0) return {-k * p1, p1 < 0 ? -k : 0.0, 0};
  // Discrete gradient of k p^2/2: exactly energy conserving through the contact.
  const double change = gap_end - gap_begin;
  if (std::abs(change) < 1e-12 * (1 + std::abs(gap_begin))) {
    out.effort = -0.5 * k * (p0 + p1);
    out.slope = p1 < 0 ? -0.5 * k : 0.0;
  } else {
    const double secant = (p1 - p0) / change, secant_slope = ((p1 < 0 ? 1.0 : 0.0) - secant) / change;
    out.effort = -0.5 * k * (p1 + p0) * secant;
    out.slope = -0.5 * k * ((p1 < 0 ? 1.0 : 0.0) * secant + (p1 + p0) * secant_slope);
  }
  // The damper acts on the rate of the penetration, which is continuous at touch and release; it never pulls.
  const double damping = -penalty.damping * (p1 - p0) / step;
  if (out.effort + damping >= 0) {
    out.effort += damping;
    out.slope -= p1 < 0 ? penalty.damping / step : 0.0;
    out.dissipated = -damping * change;
  } else {
    out.dissipated = out.effort * change;
    out.effort = out.slope = 0;
  }
  return out;
}

/// Derivative of the rate with respect to the increment.
double rate_slope(const CoordinateStep& change) {
  return 1 / (change.gamma * change.step);
}

}  // namespace

double rate_of(const CoordinateStep& change) {
  return (change.increment / change.step - (1 - change.gamma) * change.begin_rate) / change.gamma;
}

SmoothDirection smooth_direction(const CoordinateStep& change) {
  if (change.step == 0) return {};
  const double t = std::tanh(rate_of(change) / kFrictionSpeed);
  return {t, (1 - t * t) / kFrictionSpeed * rate_slope(change)};
}

StopPenalty stop_penalty(const Coordinate& coordinate, double contact_time) {
  if (!coordinate.limit) return {};
  const double inertia = coordinate.limit->inertia, omega = kPi / contact_time;
  return {inertia * omega * omega, 2 * kStopDampingRatio * inertia * omega};
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
    const LimitStop& stop = *coordinate.limit;
    const PassiveEffort low = stop_effort(penalty, change.begin - stop.lower, change.end - stop.lower, change.step);
    const PassiveEffort high = stop_effort(penalty, stop.upper - change.begin, stop.upper - change.end, change.step);
    out.effort += low.effort - high.effort;
    out.slope += low.slope + high.slope;
    out.dissipated += low.dissipated + high.dissipated;
  }
  return out;
}

double stop_energy(const Coordinate& coordinate, const StopPenalty& penalty, double position) {
  if (!coordinate.limit) return 0;
  const double p = std::min({position - coordinate.limit->lower, coordinate.limit->upper - position, 0.0});
  return 0.5 * penalty.stiffness * p * p;
}

}  // namespace flexarm
