#include "integrators/explicit_motors.h"

#include <algorithm>
#include <cmath>

#include "joints/set_points.h"

namespace flexarm {
namespace {

/// Relative to a step: how far from its ends commanded set points are evaluated, whose rate may jump there; and the
/// tolerance for the times of samples, which are sums with round-off.
constexpr double kFromEnds = 1e-9, kOffSample = 1e-6;
/// Relative to the set point: differences that are no jumps, but round-off of derivatives.
constexpr double kNoJump = 1e-9;

}  // namespace

bool ExplicitMotors::Input::operator==(const Input& other) const {
  return set_point == other.set_point && set_rate == other.set_rate && feedforward == other.feedforward &&
         held == other.held && law == other.law && off == other.off;
}

ExplicitMotors::ExplicitMotors(const Model& model, const ExplicitTableau& tableau, ExplicitMargins& margins)
    : model_(model),
      derivatives_(tableau),
      samples_(model.actuators.size()),
      sampled_(model.actuators.size()),
      held_(model.actuators.size(), 0.0),
      first_(model.actuators.size(), 0.0),
      inputs_(model.actuators.size()),
      kept_inputs_(model.actuators.size()),
      margins_(margins) {
  varies_.reserve(model.histories.size());
  limits_.reserve(model.actuators.size());
  for (const TimeFunction& history : model.histories) varies_.push_back(!history.constant());
  for (std::size_t i = 0; i < sampled_.size(); ++i)
    if (model.actuators[i].servo) sampled_[i].outputs.resize(outputs_of(*model.actuators[i].servo));
  for (const Actuator& actuator : model.actuators) {
    const bool is_limited = std::isfinite(std::min(servo_limit(model, actuator), actuator.drive.effort_limit));
    limits_.push_back(is_limited ? margins_.add() : ExplicitMargins::kNone);
  }
}

bool ExplicitMotors::has_servo(std::size_t actuator) const {
  return model_.actuators[actuator].servo && model_.coordinates[model_.actuators[actuator].coordinate].motion < 0;
}

// ---------------------------------------------------------------- inputs

void ExplicitMotors::begin(const State& state, double step) {
  begin_ = state.time;
  step_ = step;
  for (std::size_t i = 0; i < model_.actuators.size(); ++i) {
    if (!has_servo(i)) continue;
    const Servo& servo = *model_.actuators[i].servo;
    const ActuatorState& own = state.actuators[i];
    const TimeFunction* history = set_point_function(model_, servo, own.servo);
    const Coordinate& coordinate = model_.coordinates[model_.actuators[i].coordinate];
    if (servo.sample_time > 0)
      take_sample(model_.actuators[i], own, state.released[coordinate.joint].displacement[coordinate.component],
                  sampled_[i]);
    else if (history && varies_[servo.set_point])
      StageDerivatives::sample(*history, begin_, step, samples_[i]);
    if (servo.sample_time > 0) held_[i] = held_output(servo, sampled_[i], begin_, step);
  }
}

void ExplicitMotors::take_sample(const Actuator& actuator, const ActuatorState& own, double link_position,
                                 ServoState& servo) const {
  const Servo& data = *actuator.servo;
  servo = own.servo;
  const double measured = data.on_link ? link_position : own.angle;
  sample(data, sampled_input(model_, data, own.servo, measured, begin_, kOffSample * step_), servo);
}

void ExplicitMotors::set_instant(const State& state, std::size_t stage, double part,
                                 const std::vector<double>& values) {
  const double time = begin_ + std::clamp(part, kFromEnds, 1 - kFromEnds) * step_;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (!has_servo(i)) continue;
    const Servo& servo = *model_.actuators[i].servo;
    const ServoState& own = state.actuators[i].servo;
    Input& input = inputs_[i] = {};
    input.law = own.law;
    input.off = own.off;
    if (servo.sample_time > 0) {
      input.held = held_[i];
      continue;
    }
    if (servo.feedforward >= 0) input.feedforward = values[servo.feedforward];
    if (set_point_function(model_, servo, own)) {
      input.set_point = values[servo.set_point];
      if (varies_[servo.set_point]) input.set_rate = derivatives_(1, stage, samples_[i], step_);
    } else {
      input.set_point = set_point_at(model_, servo, own, begin_ + part * step_);
      input.set_rate = own.set_rate_at(time, 0);
    }
    if (stage == 0) first_[i] = input.set_point;
  }
}

// ---------------------------------------------------------------- efforts

double ExplicitMotors::cut(std::size_t actuator, const MotorRange& range, double demand) {
  margins_.set(limits_[actuator], demand, range.lowest, range.highest);
  return std::clamp(demand, range.lowest, range.highest);
}

double ExplicitMotors::effort(std::size_t actuator, const State& state, double other,
                              const ExplicitRotors::Motion& rotor, const ExplicitRotors::Motion& link, double integral,
                              double& integral_rate) {
  const Actuator& data = model_.actuators[actuator];
  integral_rate = 0;
  const MotorRange range = motor_range(data.drive, servo_limit(model_, data), rotor.rate);
  if (!data.servo) return cut(actuator, range, other);
  const Servo& servo = *data.servo;
  const Input& input = inputs_[actuator];
  if (input.off > 0) return 0;
  if (servo.sample_time > 0) return cut(actuator, range, other + input.held);
  const ServoLaw& law = law_of(servo, state.actuators[actuator].servo);
  const ExplicitRotors::Motion& measured = servo.on_link ? link : rotor;
  const ServoInstant at{input.set_point, input.set_rate, measured.angle, measured.rate, integral, input.feedforward};
  const double demand = other + servo_effort(law, at), given = cut(actuator, range, demand);
  integral_rate = flexarm::integral_rate(law, at, given - demand);
  return given;
}

const TimeFunction* ExplicitMotors::striking_function(std::size_t actuator, const State& state) const {
  const Actuator& data = model_.actuators[actuator];
  if (std::isfinite(std::min(servo_limit(model_, data), data.drive.effort_limit))) return nullptr;
  const TimeFunction* function = striking_set_point(model_, data, state.actuators[actuator].servo);
  return function && varies_[data.servo->set_point] ? function : nullptr;
}

/// The impulse by a change of the set point of which a part is smooth.
double ExplicitMotors::impulse_by(std::size_t actuator, const State& state, double from, double to,
                                  double smooth) const {
  const double jump = to - from - smooth;
  const ServoLaw& law = law_of(*model_.actuators[actuator].servo, state.actuators[actuator].servo);
  return std::abs(jump) > kNoJump * (std::abs(from) + std::abs(to)) ? law.derivative * jump : 0;
}

double ExplicitMotors::first_impulse(std::size_t actuator, const State& state) const {
  const TimeFunction* history = striking_function(actuator, state);
  if (!history) return 0;
  return impulse_by(actuator, state, set_point_at_border(*history, begin_, step_), first_[actuator], 0);
}

double ExplicitMotors::later_impulse(std::size_t actuator, const State& state,
                                     const std::vector<double>& weights) const {
  const TimeFunction* history = striking_function(actuator, state);
  if (!history) return 0;
  double smooth = 0;
  for (std::size_t s = 0; s < weights.size(); ++s)
    if (weights[s] != 0) smooth += step_ * weights[s] * derivatives_(1, s, samples_[actuator], step_);
  return impulse_by(actuator, state, first_[actuator], set_point_at_border(*history, begin_ + step_, step_), smooth);
}

void ExplicitMotors::accept(std::size_t actuator, double step, const ExplicitRotors::Motion& rotor,
                            const ExplicitRotors::Motion& link, double integral, ServoState& servo) const {
  if (!has_servo(actuator)) return;
  if (model_.actuators[actuator].servo->sample_time > 0) {
    servo = sampled_[actuator];
  } else {
    const Input& input = inputs_[actuator];
    const double rate = (model_.actuators[actuator].servo->on_link ? link : rotor).rate;
    const bool is_velocity = law_of(*model_.actuators[actuator].servo, servo).mode == ServoMode::Velocity;
    servo.integral = integral;
    servo.average = step * ((is_velocity ? input.set_point : input.set_rate) - rate);
    servo.delayed_rate = -rate;
  }
  if (servo.off > 0) servo.integral = 0;
}

}  // namespace flexarm
