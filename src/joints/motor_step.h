#pragma once
/// The motor of a coordinate over a step. (docs/notes/drives.md)
///
/// The rotor's angle behind an elastic gear meets nothing but the coordinate, so it is solved for here, in each trial
/// configuration: what is left is an effort on the coordinate, and its derivative with the rotor following.

#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// What a motor is asked for over a step: a function of the increments of its rotor and of the coordinate.
struct MotorDemand {
  double constant = 0, by_rotor = 0, by_link = 0;
  double surplus = 0;               ///< of the constant, above what is asked at the end: see StepForce
  double limit = Drive::kInfinity;  ///< at which it is cut, whatever the motor could give
  double at(double rotor, double link) const { return constant + by_rotor * rotor + by_link * link; }
};

/// How a rotor's motion follows from its increment u over the step.
struct RotorStep {
  CoordinateStep change;  ///< its own; increment and end are left open
  /// Mean acceleration of the step, and rate at its end: offset + slope u.
  double acceleration_offset = 0, acceleration_slope = 0, rate_offset = 0, rate_slope = 0;
  bool rests = false;  ///< at the beginning
};

struct MotorAction {
  double effort = 0, slope = 0;  ///< on the coordinate, and its derivative with respect to its increment
  double increment = 0;          ///< of the rotor
  double follows = 0;            ///< derivative of that with respect to the coordinate's increment
  double effort_by_load = 0, increment_by_load = 0;  ///< of both, with respect to an effort against the rotor
  double motor = 0, demand = 0;                      ///< the motor's effort, and what was asked of it
  double motor_at_end = 0;                           ///< the motor's effort without the demand's surplus
  double dissipated = 0;                             ///< [J]
  bool is_stopped = false;                           ///< dry friction holds the rotor at rest at the end
};

/// What a motor can give at an instant: efforts between `lowest` and `highest`.
struct MotorRange {
  double lowest, highest;
};
/// Up to `limit`, at the rate of its rotor.
MotorRange motor_range(const Drive& drive, double limit, double rate);

/// `link`: step of the coordinate; `guess`: of the rotor's increment.
MotorAction motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                         const CoordinateStep& link, double guess);
/// The same of a rotor behind an elastic gear that stays where it is.
MotorAction held_motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                              const CoordinateStep& link);

}  // namespace flexarm
