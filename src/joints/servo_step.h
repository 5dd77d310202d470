#pragma once
/// Efforts of controllers (servos) over a step. (docs/notes/drives.md)
///
/// The demand of a continuous controller is affine in the increment of the measured quantity, so its coefficients are
/// known at the beginning of the step. It is the control law for means over the step, plus two terms of second order.
/// With high gains and without these terms, the mid-point rule would let the error change its sign in each step.
/// With the increment s of the error, its moving average a, and the rate v of the measured quantity, the terms are
///   proportional [(s - a) stiffness - (v_1 - v_0)/h inertance]   with a_1 = a_0 + forgetting (s - a_0),
/// whose coefficients are those of a NumericalDissipation of second order, and a damper against v with the three parts
/// of DamperParts for the derivative gain.
///
/// A sampled controller measures at the beginning of the step in which a sample is due, and holds its output.

#include "flexarm/math/time_function.h"
#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// The set point over a step.
struct SetPoint {
  SetPoint() = default;
  SetPoint(double at_begin, double at_end, double rate = 0)
      : begin(at_begin),
        end(at_end),
        rate_at_end(rate),
        mean(0.5 * (at_begin + at_end)),
        acting(at_end),
        acting_rate(rate) {}
  double begin = 0, end = 0;
  double rate_at_end = 0;
  double mean = 0;                     ///< over the step
  double acting = 0, acting_rate = 0;  ///< for efforts at the end of the step, see StepForce
};

/// Returns the set point that a function gives at an end of a step, just before the time [s]. So where it jumps at the
/// end of a step, all steps agree on which one contains the jump, though their times differ by round-off.
double set_point_at_border(const TimeFunction& history, double time, double step);

/// What a controller needs to know about a step.
struct ServoInput {
  double time = 0;          ///< at the beginning [s]
  CoordinateStep measured;  ///< the measured quantity; increment and end are not set
  double begin_rate = 0;    ///< of the measured quantity; in conserving schemes by their own rule
  /// Rate at the end of the step, for efforts at the end: offset + slope increment.
  double rate_offset = 0, rate_slope = 0;
  SetPoint set_point;
  double feedforward = 0;
  /// Time constant of the stabilising terms [s]; 0: none, as for efforts at an instant, and in steps in which something
  /// may strike.
  double relaxation = 0;
};

/// The demanded effort over a step as a function of the measured increment: constant + slope increment.
struct ServoDemand {
  double constant = 0, slope = 0;
};

ServoDemand servo_demand(const ServoLaw& law, const ServoState& state, const ServoInput& input);
/// Returns MotorDemand::surplus without the part of the feedforward: the constant of servo_demand() minus the demand at
/// the end of the step.
double servo_surplus(const ServoLaw& law, const ServoInput& input);
/// Updates a controller's memory at the end of a step. `increment`: of the measured quantity; `excess`: the motor's
/// effort minus the demanded one.
void advance(const ServoLaw& law, const ServoInput& input, double increment, double excess, ServoState& state);

/// Returns only the integral that advance() would set.
double integral_at_end(const ServoLaw& law, const ServoInput& input, double increment, double excess,
                       const ServoState& state);

/// Input of a control law at an instant.
struct ServoInstant {
  double set_point = 0, set_rate = 0;
  double measured = 0, rate = 0;  ///< the measured quantity and its rate
  double integral = 0, feedforward = 0;
};
/// Returns the demanded effort of a continuous controller at an instant [N m or N].
double servo_effort(const ServoLaw& law, const ServoInstant& at);

/// Returns the rate of a controller's integral at an instant: of the error, or of the angle that a controller of
/// velocity has to make up for. With back-calculation it follows the motor's effort minus the demanded one, `excess`.
double integral_rate(const ServoLaw& law, const ServoInstant& at, double excess);

/// Sets a controller's memory as if it had always been at rest with this measured position and this output.
void settle(double measured, double output, ServoState& state);
/// Moves the proportional part of the effort into the integral, so that the error can become zero. Returns the absolute
/// value of the error; 0, and does nothing, if the law has no integral of a position error.
double hand_to_integral(const ServoLaw& law, double error, ServoState& state);

// ---- sampled controllers

/// What a sampled controller is given at the time of a sample. Where a function of time jumps then, its value is that
/// after the jump.
struct SampledInput {
  double time = 0;         ///< [s]
  double tolerance = 0;    ///< times may be earlier by this, since they are sums with round-off [s]
  double measured = 0;     ///< the position of the rotor or of the coordinate
  double set_point = 0;    ///< in the unit of the mode
  double set_rate = 0;     ///< mean rate of the set point since the last sample
  double feedforward = 0;  ///< [N m or N]
};
/// Takes a sample if one is due.
void sample(const Servo& servo, const SampledInput& input, ServoState& state);
/// Returns the mean of the held output over the step.
double held_output(const Servo& servo, const ServoState& state, double time, double step);
/// Returns how many outputs the controller's memory needs.
std::size_t outputs_of(const Servo& servo);

}  // namespace flexarm
