#pragma once
/// Passive efforts on a released coordinate: viscous damping, smooth Coulomb friction, stops. (beyond.md 3)

#include "joints/coordinate_step.h"
#include "joints/joint_stop.h"
#include "model/model.h"

namespace flexarm {

/// Speed at which the smooth Coulomb effort F tanh(rate / v) is established [rad/s or m/s].
constexpr double kFrictionSpeed = 1e-3;

/// Smooth friction acts by this part of its capacity, tanh(rate / v), against the increment.
struct SmoothDirection {
  double value = 0, slope = 0;  ///< and its derivative with respect to the increment
};
/// Zero in statics.
SmoothDirection smooth_direction(const CoordinateStep& change);
/// True where between these rates the direction changes by more than a half of the refinement's inverse.
bool is_coarse_turn(double begin_rate, double end_rate, double refinement);

/// True where passive_effort() may be more than nothing.
inline bool resists(const Coordinate& coordinate) {
  return coordinate.damping > 0 || (coordinate.friction > 0 && !coordinate.sticks) || coordinate.limit;
}
/// Of damping, stops and smooth friction of constant capacity.
PassiveEffort passive_effort(const Coordinate& coordinate, const StopPenalty& penalty, const CoordinateStep& change);

}  // namespace flexarm
