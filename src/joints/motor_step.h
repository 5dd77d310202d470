#pragma once
/// The effort of a coordinate's motor over a step. (docs/notes/drives.md)
///
/// The angle of a rotor behind an elastic gear is coupled with the coordinate only. So it is solved for here, for each
/// trial increment of the coordinate. The result is an effort on the coordinate, and its total derivative, in which the
/// rotor follows the coordinate.

#include <cmath>

#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// The demanded effort of a motor over a step: an affine function of the increments of its rotor and of the coordinate
/// (link).
struct MotorDemand {
  double constant = 0, by_rotor = 0, by_link = 0;
  double surplus = 0;               ///< constant minus the demand at the end of the step, see StepForce
  double limit = Drive::kInfinity;  ///< at which the demand is cut, in addition to the motor's own limits
  double at(double rotor, double link) const { return constant + by_rotor * rotor + by_link * link; }
};

/// The motion of a rotor as a function of its increment u over the step.
struct RotorStep {
  CoordinateStep change;  ///< of the rotor; increment and end are not set
  /// Mean acceleration over the step, and rate at its end: offset + slope u.
  double acceleration_offset = 0, acceleration_slope = 0, rate_offset = 0, rate_slope = 0;
  bool rests = false;  ///< the rotor is at rest at the beginning
};

/// The result of a motor's step.
struct MotorAction {
  double effort = 0, slope = 0;  ///< on the coordinate, and its derivative with respect to the coordinate's increment
  double increment = 0;          ///< of the rotor
  double follows = 0;            ///< derivative of `increment` with respect to the coordinate's increment
  double effort_by_load = 0, increment_by_load = 0;  ///< derivatives with respect to an effort against the rotor
  double motor = 0, demand = 0;                      ///< the motor's effort, and the demanded one
  double motor_at_end = 0;                           ///< the motor's effort without the demand's surplus
  double dissipated = 0;                             ///< over the step [J]
  bool is_stopped = false;                           ///< dry friction holds the rotor at rest at the end
};

/// The range of efforts that a motor can give at an instant.
struct MotorRange {
  double lowest, highest;
};
/// Returns the range at a rate of the rotor, cut at +-`limit`.
MotorRange motor_range(const Drive& drive, double limit, double rate);

/// The largest effort of a motor's friction, if its gear transmits this effort.
inline double friction_capacity(const Drive& drive, double transmitted) {
  return drive.friction + drive.loss * std::abs(transmitted);
}

/// Computes the action of a motor. `link`: the coordinate's step; `guess`: initial guess of the rotor's increment.
MotorAction motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                         const CoordinateStep& link, double guess);
/// The same for a rotor behind an elastic gear that does not move in this step.
MotorAction held_motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                              const CoordinateStep& link);

}  // namespace flexarm
