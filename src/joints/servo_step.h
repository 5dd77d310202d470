#pragma once
/// Controllers over a step. (docs/notes/drives.md)
///
/// What a continuous controller asks for is affine in the increment of what it measures, and so known at the beginning
/// of the step. It is that of means over the step, to which two terms of second order are added that bring stiff gains
/// to rest: with the error's increment s, its average a and the rate v of what is measured,
///   proportional [(s - a) stiffness - (v_1 - v_0)/h inertance]   with a_1 = a_0 + forgetting (s - a_0)
/// as NumericalDissipation of the second order has it, and the three parts of DamperParts against v. Without them the
/// mid-point rule would let an error that infinite gains leave alternate for ever.
///
/// A sampled one measures at the beginning of the step in which a sample is due, and holds its output.

#include "joints/coordinate_step.h"
#include "model/actuator.h"

namespace flexarm {

/// Over a step, of the set point.
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
  double acting = 0, acting_rate = 0;  ///< where efforts are those at the end: see StepForce
};

struct ServoInput {
  double time = 0;          ///< at the beginning [s]
  CoordinateStep measured;  ///< its increment and end are left open
  double begin_rate = 0;    ///< of what is measured; with conserving schemes by their own rule
  /// Rate at the end, where efforts are those at the end: offset + slope increment.
  double rate_offset = 0, rate_slope = 0;
  SetPoint set_point;
  double feedforward = 0;
  double relaxation = 0;  ///< of stiff gains [s]; 0: none, as where efforts are those at an instant
};

/// What a controller asks for over a step: constant + slope increment.
struct ServoDemand {
  double constant = 0, slope = 0;
};

ServoDemand servo_demand(const ServoLaw& law, const ServoState& state, const ServoInput& input);
/// How far the constant is above what is asked for at the end of the step, as MotorDemand::surplus; but for
/// feedforward.
double servo_surplus(const ServoLaw& law, const ServoInput& input);
/// Its memory at the end of the step, in which what is measured moved by `increment`, and `excess` is what the motor
/// gave less what was asked of it.
void advance(const ServoLaw& law, const ServoInput& input, double increment, double excess, ServoState& state);

/// The integral alone of that memory.
double integral_at_end(const ServoLaw& law, const ServoInput& input, double increment, double excess,
                       const ServoState& state);

/// What the laws of controllers take at an instant.
struct ServoInstant {
  double set_point = 0, set_rate = 0;
  double measured = 0, rate = 0;  ///< of what is measured
  double integral = 0, feedforward = 0;
};
/// What a continuous controller asks for at an instant [N m or N].
double servo_effort(const ServoLaw& law, const ServoInstant& at);

/// Its memory where it has been at rest for ever, with that position and output.
void settle(double measured, double output, ServoState& state);
/// Lets the integral take over what is in proportion to the error; returns that error, in absolute value, or 0 where
/// nothing integrates.
double hand_to_integral(const ServoLaw& law, double error, ServoState& state);

// ---- sampled controllers

/// Takes a sample if one is due. `set_rate`: of the set point since the last sample.
void sample(const Servo& servo, const ServoInput& input, double set_rate, ServoState& state);
/// Mean over the step of what is held.
double held_output(const Servo& servo, const ServoState& state, double time, double step);
/// Outputs that are to be remembered.
std::size_t outputs_of(const Servo& servo);

}  // namespace flexarm
