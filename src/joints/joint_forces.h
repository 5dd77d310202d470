#pragma once
/// Passive efforts on a released coordinate: viscous damping, smooth Coulomb friction, stops. (beyond.md 3)

#include "joints/coordinate_step.h"
#include "joints/joint_stop.h"
#include "model/model.h"

namespace flexarm {

/// The speed v of the smooth Coulomb effort F tanh(rate / v) [rad/s or m/s].
constexpr double kFrictionSpeed = 1e-3;

/// Smooth friction against a rate, divided by its capacity F, at an instant.
double smooth_friction(double rate);
/// Smooth friction against the increment, divided by its capacity F: tanh(rate / v).
struct SmoothDirection {
  double value = 0, slope = 0;  ///< `slope`: derivative with respect to the increment
};
/// The capacity of a coordinate's friction at the rate of a step, relative to that of fast sliding (Stribeck's curve),
/// and its derivative with respect to the increment. It is 1 in statics. (docs/theory/joints.md)
struct FrictionRise {
  double value = 1, slope = 0;
};
FrictionRise friction_rise(const Coordinate& coordinate, const CoordinateStep& change);
/// Returns the smooth friction per capacity; zero in statics.
SmoothDirection smooth_direction(const CoordinateStep& change);
/// Whether smooth friction per capacity changes by more than 1 / (2 refinement) between these rates.
bool is_coarse_turn(double begin_rate, double end_rate, double refinement);

/// Whether passive_effort() may be different from zero.
inline bool resists(const Coordinate& coordinate) {
  return coordinate.damping > 0 || (coordinate.friction > 0 && !coordinate.sticks) || coordinate.limit;
}
/// Returns the effort of damping, stops, and smooth friction of constant capacity.
PassiveEffort passive_effort(const Coordinate& coordinate, const CoordinateStep& change);

}  // namespace flexarm
