#include "simulation/servo_commands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "integrators/step_histories.h"

namespace flexarm {
namespace {

/// Of a motor, what neither the servo's error nor its integral asks for [N m or N].
double other_efforts(const Model& model, const Servo& servo, const Coordinate& coordinate, double command,
                     double time) {
  const auto value = [&](int history) { return history >= 0 ? model.histories[history](time) : 0.0; };
  return applied_effort(coordinate, command, value(coordinate.effort)) + value(servo.feedforward);
}

/// The integral with which the servo gives that effort where it has no error; 0 where nothing integrates.
double integral_for(const ServoLaw& law, double effort) {
  const double gain = law.mode == ServoMode::Velocity ? law.proportional : law.integral;
  return gain > 0 ? effort / gain : 0.0;
}

}  // namespace

void require_hit_samples(const Model& model, double step) {
  for (const Actuator& actuator : model.actuators)
    if (actuator.servo && !hits_samples(step, actuator.servo->sample_time))
      throw std::invalid_argument(
          fmt::format("a step of {:g} s does not divide the sample time of the servo of '{}', {} s", step,
                      model.coordinates[actuator.coordinate].name, actuator.servo->sample_time));
}

bool has_servo(const Model& model, std::size_t coordinate) {
  const int actuator = model.coordinates.at(coordinate).actuator;
  return actuator >= 0 && model.actuators[actuator].servo;
}

const Servo& servo_of(const Model& model, std::size_t coordinate) {
  if (!has_servo(model, coordinate))
    throw std::invalid_argument(
        fmt::format("joint coordinate '{0}' has no servo: write <servo joint=\"{0}\" mode=\"...\" .../> into the scene",
                    model.coordinates[coordinate].name));
  return *model.actuators[model.coordinates[coordinate].actuator].servo;
}

ServoState& servo_of(const Model& model, std::size_t coordinate, State& state) {
  servo_of(model, coordinate);
  return state.actuators[model.coordinates[coordinate].actuator].servo;
}

void command_set_point(ServoState& servo, double set_point, double rate, double acceleration, double arrival) {
  for (const double number : {set_point, rate, acceleration})
    if (!std::isfinite(number)) throw std::invalid_argument("a commanded set point must be finite");
  servo.set_point = set_point;
  servo.set_rate = rate;
  servo.set_acceleration = acceleration;
  servo.set_time = arrival;
}

double set_point(const Servo& servo, const Model& model, const ServoState& state, double time) {
  if (!std::isnan(state.set_point)) return state.set_point;
  return servo.set_point >= 0 ? model.histories[servo.set_point](time) : servo.start;
}

void release_set_point(const Model& model, std::size_t coordinate, State& state) {
  if (!has_servo(model, coordinate)) return;
  ServoState& servo = servo_of(model, coordinate, state);
  if (servo.law != 0) servo.integral = servo.average = 0;
  servo.law = 0;
  servo.set_point = std::numeric_limits<double>::quiet_NaN();
  servo.set_rate = servo.set_acceleration = 0;
}

void switch_mode(const Model& model, std::size_t coordinate, ServoMode mode, double position, double velocity,
                 State& state) {
  const Servo& servo = servo_of(model, coordinate);
  const auto law =
      std::find_if(servo.laws.begin(), servo.laws.end(), [&](const ServoLaw& one) { return one.mode == mode; });
  if (law == servo.laws.end())
    throw std::invalid_argument(fmt::format(
        "the servo of '{}' has no gains of mode '{}': write <gains mode=\"{}\" kp=\"...\"/> into its <servo>",
        model.coordinates[coordinate].name, to_string(mode), to_string(mode)));
  ServoState& own = servo_of(model, coordinate, state);
  if (&law_of(servo, own) == &*law) return;
  const Coordinate& place = model.coordinates[coordinate];
  const ActuatorState& actuator = state.actuators[place.actuator];
  const double given = own.off > 0 ? 0.0
                                   : state.efforts[coordinate] -
                                         other_efforts(model, servo, place, state.commands[coordinate], state.time);
  own.law = static_cast<double>(law - servo.laws.begin());
  own.integral = integral_for(*law, given);
  own.average = 0;
  const double set_point = mode == ServoMode::Effort     ? given
                           : mode == ServoMode::Velocity ? velocity
                           : servo.on_link               ? position
                                                         : actuator.angle;
  command_set_point(own, set_point, 0, 0, state.time);
}

}  // namespace flexarm
