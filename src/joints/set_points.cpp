#include "joints/set_points.h"

#include <algorithm>
#include <cmath>

namespace flexarm {

const TimeFunction* set_point_function(const Model& model, const Servo& servo, const ServoCommand& command) {
  return servo.set_point >= 0 && std::isnan(command.set_point) ? &model.histories[servo.set_point] : nullptr;
}

double set_point_at(const Model& model, const Servo& servo, const ServoCommand& command, double time) {
  if (!std::isnan(command.set_point)) return command.set_point_at(time);
  const TimeFunction* function = set_point_function(model, servo, command);
  return function ? (*function)(time) : servo.start;
}

double set_rate_at(const Model& model, const Servo& servo, const ServoCommand& command, double time) {
  if (!std::isnan(command.set_point)) return command.set_rate_at(time, 0);
  const TimeFunction* function = set_point_function(model, servo, command);
  return function ? function->derivative(time) : 0;
}

SampledInput sampled_input(const Model& model, const Servo& servo, const ServoCommand& command, double measured,
                           double time, double tolerance) {
  // By a straight line through two points behind the time, so that round-off of the time does not matter at a jump.
  const auto after = [&](const TimeFunction& function, double at) {
    return 2 * function(at + tolerance) - function(at + 2 * tolerance);
  };
  const double period = servo.sample_time;
  SampledInput out{time, tolerance, measured};
  if (const TimeFunction* function = set_point_function(model, servo, command)) {
    out.set_point = after(*function, time);
    out.set_rate = (out.set_point - after(*function, time - period)) / period;
  } else {
    out.set_point = set_point_at(model, servo, command, time);
    out.set_rate = command.set_rate_at(time - 0.5 * period, tolerance);
  }
  if (servo.feedforward >= 0) out.feedforward = after(model.histories[servo.feedforward], time);
  return out;
}

const TimeFunction* striking_set_point(const Model& model, const Actuator& actuator, const ServoState& state) {
  if (!actuator.servo || actuator.servo->sample_time > 0 || state.off > 0) return nullptr;
  if (model.coordinates[actuator.coordinate].motion >= 0) return nullptr;
  const ServoLaw& law = law_of(*actuator.servo, state);
  if (law.mode != ServoMode::Position || law.derivative == 0) return nullptr;
  return set_point_function(model, *actuator.servo, state);
}

double servo_limit(const Model& model, const Actuator& actuator) {
  if (!actuator.servo) return Drive::kInfinity;
  const double of_coordinate = model.coordinates[actuator.coordinate].effort_limit;
  return of_coordinate > 0 ? std::min(of_coordinate, actuator.servo->effort_limit) : actuator.servo->effort_limit;
}

}  // namespace flexarm
