#pragma once
/// Passive efforts on a released coordinate: viscous damping, smooth Coulomb friction, stops. (beyond.md 3-4)

#include "model/model.h"

namespace flexarm {

/// Speed at which the smooth Coulomb effort F tanh(rate / v) is established [rad/s or m/s].
constexpr double kFrictionSpeed = 1e-3;

/// Change of a coordinate over a step, and how its rate is formed:
/// rate = (increment / step - (1 - gamma) begin_rate) / gamma; gamma = 1 gives the mean rate of conserving schemes.
struct CoordinateStep {
  double begin = 0, end = 0;  ///< positions
  double increment = 0;       ///< end - begin, or a component of a tangent-scaled rotation increment
  double step = 0;            ///< [s]; 0: statics (no damping, no friction)
  double gamma = 1, begin_rate = 0;
};

/// The rate that damping and smooth friction feel. Not in statics.
double rate_of(const CoordinateStep& change);

/// Smooth friction acts by this part of its capacity, tanh(rate / v), against the increment.
struct SmoothDirection {
  double value = 0, slope = 0;  ///< and its derivative with respect to the increment
};
/// Zero in statics.
SmoothDirection smooth_direction(const CoordinateStep& change);

/// By which the stops of a coordinate hold.
struct StopPenalty {
  double stiffness = 0, damping = 0;  ///< [N/m or N m/rad], [N s/m or N m s/rad]
};
/// Such that a contact lasts `contact_time` [s] were it without damping, and gives 30 % of the speed back.
StopPenalty stop_penalty(const Coordinate& coordinate, double contact_time);

/// Effort on the coordinate, its derivative with respect to the increment, and the energy that it dissipates over the
/// step.
struct PassiveEffort {
  double effort = 0, slope = 0, dissipated = 0;
};
/// True where passive_effort() may be more than nothing.
inline bool resists(const Coordinate& coordinate) {
  return coordinate.damping > 0 || (coordinate.friction > 0 && !coordinate.sticks) || coordinate.limit;
}
/// Of damping, stops and smooth friction of constant capacity.
PassiveEffort passive_effort(const Coordinate& coordinate, const StopPenalty& penalty, const CoordinateStep& change);

/// Elastic energy of the coordinate's stop at `position` [J].
double stop_energy(const Coordinate& coordinate, const StopPenalty& penalty, double position);

}  // namespace flexarm
