#include "simulation/servo_commands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "integrators/step_histories.h"
#include "joints/servo_step.h"
#include "simulation/entry.h"

namespace flexarm {
namespace {

/// The part of a motor's effort that comes neither from the servo's error nor from its integral [N m or N].
double other_efforts(const Model& model, const Servo& servo, const Coordinate& coordinate, double command,
                     double time) {
  const auto value = [&](int history) { return history >= 0 ? model.histories[history](time) : 0.0; };
  return applied_effort(coordinate, command, value(coordinate.effort)) + value(servo.feedforward);
}

/// What a servo measures [rad or m, and per second], and the rate on which its derivative term acts.
struct Measured {
  double position = 0, velocity = 0, rate = 0;
};

Measured measured(const Servo& servo, const Actuator& actuator, const ActuatorState& own, const State& state,
                  double position, double velocity) {
  Measured out{position, velocity, velocity};
  if (!servo.on_link) {
    out.position = own.angle;
    out.velocity = own.rate;
    if (const std::optional<Gyroscope>& gyroscope = actuator.gyroscope)
      out.velocity -= gyroscope->axis.dot(state.nodes[gyroscope->node].angular_velocity) / gyroscope->ratio;
    out.rate = out.velocity;
  }
  if (servo.sample_time == 0) return out;
  const double ahead = std::max(own.servo.samples * servo.sample_time - state.time, 0.0);
  out.rate = (out.position + ahead * out.velocity - own.servo.measured) / servo.sample_time;
  return out;
}

/// Effort that the servo gives at the end of the step [N m or N]. For a sampled servo it is the newest output, even if
/// that is still delayed.
double given_effort(const Model& model, const Servo& servo, const Coordinate& coordinate, std::size_t index,
                    double step, const State& state) {
  const ServoState& own = state.actuators[coordinate.actuator].servo;
  if (own.off > 0) return 0;
  const double given =
      state.efforts[index] - other_efforts(model, servo, coordinate, state.commands[index], state.time);
  if (servo.sample_time == 0) return given;
  return given + own.outputs.front() - held_output(servo, own, state.time - step, step);
}

/// Makes the law begin with this effort: by its integral, or, if it has none, by its set point.
void take_over(const ServoLaw& law, double given, const Measured& now, double time, ServoState& state) {
  const bool is_velocity = law.mode == ServoMode::Velocity;
  const double set_rate = is_velocity ? now.velocity : 0;
  const double left = given + law.derivative * (now.rate - set_rate);
  const double integral = is_velocity ? law.proportional : law.integral;
  const double other = is_velocity ? law.derivative : law.proportional;
  double set_point = is_velocity ? now.velocity : now.position;
  state.integral = 0;
  if (integral > 0)
    state.integral = left / integral;
  else if (other > 0)
    set_point += left / other;
  command_set_point(state, set_point, 0, 0, time);
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
  const int actuator = entry(model.coordinates, coordinate, "joint coordinate").actuator;
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
                 double step, State& state) {
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
  const bool is_on = own.off == 0;
  const double given = given_effort(model, servo, place, coordinate, step, state);
  Measured now = measured(servo, model.actuators[place.actuator], actuator, state, position, velocity);
  if (!is_on) now.rate = mode == ServoMode::Velocity ? now.velocity : 0;  // there is no effort to continue
  own.law = static_cast<double>(law - servo.laws.begin());
  // Set the error's increments as if the new law had been in force before.
  own.average = mode == ServoMode::Position && is_on ? -step * now.velocity : 0;
  if (mode == ServoMode::Effort) {
    own.integral = 0;
    command_set_point(own, given, 0, 0, state.time);
  } else {
    take_over(*law, given, now, state.time, own);
  }
}

}  // namespace flexarm
