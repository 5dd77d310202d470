#pragma once
/// What servos of a model follow, and how far their efforts go. (docs/notes/drives.md 5)

#include "joints/servo_step.h"
#include "model/actuator.h"
#include "model/model.h"

namespace flexarm {

/// The function of time of the scene that a servo's set point follows; null if there is none, or a command is in force.
const TimeFunction* set_point_function(const Model& model, const Servo& servo, const ServoCommand& command);
/// The set point at a time [s], in the unit of the servo's mode.
double set_point_at(const Model& model, const Servo& servo, const ServoCommand& command, double time);
/// The rate of the set point at a time.
double set_rate_at(const Model& model, const Servo& servo, const ServoCommand& command, double time);
/// What a sampled servo is given at a time [s], at which it measures `measured`. `tolerance`: see SampledInput.
SampledInput sampled_input(const Model& model, const Servo& servo, const ServoCommand& command, double measured,
                           double time, double tolerance);
/// As set_point_function(); null also if the derivative of the servo's error does not act on the coordinate at each
/// instant. So where the function jumps, the servo strikes, unless its motor has a limit.
const TimeFunction* striking_set_point(const Model& model, const Actuator& actuator, const ServoState& state);
/// The limit of a motor's effort that its servo and its coordinate set, besides those of the drive [N m or N].
double servo_limit(const Model& model, const Actuator& actuator);

}  // namespace flexarm
