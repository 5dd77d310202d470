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
