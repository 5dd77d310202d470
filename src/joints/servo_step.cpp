#include "joints/servo_step.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "schemes/scheme.h"

namespace flexarm {
namespace {

/// Spectral radius of an infinitely stiff controller: the factor by which a step of the scene's length reduces its
/// error.
constexpr double kStiffRemainder = 0.5;
/// Tolerance for the times of samples, relative to the step. Times of steps are sums with round-off.
constexpr double kRoundOff = 1e-6;

/// How far before an end of a step a set point is taken, relative to the step and to the time: far more than round-off.
constexpr double kBeforeStep = 1e-9, kBeforeTime = 1e-14;

double error_at_begin(const ServoLaw& law, const ServoState& state, const ServoInput& input) {
  return law.mode == ServoMode::Velocity ? state.integral : input.set_point.begin - input.measured.begin;
}

/// Returns the increment of the error over the step that is due to the set point.
double set_increment(const ServoLaw& law, const ServoInput& input) {
  const SetPoint& s = input.set_point;
  return law.mode == ServoMode::Velocity ? input.measured.step * s.mean : s.end - s.begin;
}

/// An effort per unit gain as a function of the error's increment s over the step: offset + slope s.
struct Term {
  double offset = 0, slope = 0;
};

Term proportional_term(double error, const ServoState& state, const ServoInput& input) {
  const double h = input.measured.step;
  if (h == 0 || input.measured.at_end) return {error, 1};
  Term out{error, 0.5};
  if (input.relaxation == 0) return out;
  const NumericalDissipation d = numerical_dissipation(2, kStiffRemainder, input.relaxation);
  out.slope += d.stiffness;
  out.offset -= d.stiffness * state.average;
  return out;
}

/// Returns the effort per acceleration of the measured quantity, with which the two stabilising terms (see
/// servo_step.h) resist that acceleration.
double inertance(const ServoLaw& law, const ServoInput& input) {
  if (input.relaxation == 0) return 0;
  return law.proportional * numerical_dissipation(2, kStiffRemainder, input.relaxation).inertance +
         law.derivative * 0.25 * input.relaxation;
}

/// The effort of the derivative per unit gain, as a function of the negative increment of the measured quantity.
Term derivative_term(const ServoState& state, const ServoInput& input) {
  const double h = input.measured.step, relaxation = input.relaxation;
  if (relaxation == 0) return {0, 1 / h};
  const double follows = 1 / (h + 2 * relaxation);
  return {0.25 * 2 * relaxation * follows * state.delayed_rate, 0.75 / h + 0.25 * follows};
}

/// Returns the rate of the set point, for efforts at the end of the step.
double acting_rate(const ServoLaw& law, const SetPoint& set) {
  return law.mode == ServoMode::Velocity ? set.acting : set.acting_rate;
}

/// By what the integral is multiplied in the demand.
double integral_gain(const ServoLaw& law) {
  return law.mode == ServoMode::Velocity ? law.proportional : law.integral;
}

/// Whether the integral follows a saturated effort.
bool calculates_back(const ServoLaw& law) {
  return law.tracking_time > 0 && integral_gain(law) > 0;
}

double integral_share(const ServoInput& input) {
  return input.measured.at_end ? 1.0 : 0.5;
}

}  // namespace

double set_point_at_border(const TimeFunction& history, double time, double step) {
  const double before = time - kBeforeStep * std::abs(step) - kBeforeTime * std::abs(time);
  return history(time >= 0 ? std::max(before, 0.0) : before);
}

ServoDemand servo_demand(const ServoLaw& law, const ServoState& state, const ServoInput& input) {
  const double h = input.measured.step;
  const SetPoint& set = input.set_point;
  if (law.mode == ServoMode::Effort) {
    const bool is_mean = h != 0 && !input.measured.at_end;
    return {input.feedforward + (is_mean ? set.mean : h == 0 ? set.end : set.acting), 0};
  }
  const double error = error_at_begin(law, state, input);
  Term sum{input.feedforward, 0};  // a function of the error's increment
  const auto add = [&](double gain, const Term& term) {
    sum.offset += gain * term.offset;
    sum.slope += gain * term.slope;
  };
  add(law.proportional, proportional_term(error, state, input));
  const double share = integral_share(input);
  add(law.integral, {state.integral + share * h * error, 0.5 * share * h});
  const double by_set = set_increment(law, input);
  ServoDemand out{sum.offset + sum.slope * by_set, -sum.slope};
  if (h == 0) {
    if (law.mode == ServoMode::Velocity) out.slope = 0;  // in statics all rates are zero
    return out;
  }
  if (input.measured.at_end) {  // the rate at the end
    out.constant += law.derivative * (acting_rate(law, set) - input.rate_offset);
    out.slope -= law.derivative * input.rate_slope;
    return out;
  }
  const Term derivative = derivative_term(state, input);
  out.constant += law.derivative * (by_set / h + derivative.offset);
  out.slope -= law.derivative * derivative.slope;
  // (v_1 - v_0)/h = 2 (u/h - v_0)/h
  const double resisting = 2 * inertance(law, input) / h;
  out.constant += resisting * input.begin_rate;
  out.slope -= resisting / h;
  return out;
}

double servo_surplus(const ServoLaw& law, const ServoInput& input) {
  const SetPoint& set = input.set_point;
  if (!input.measured.at_end || input.measured.step == 0) return 0;
  if (law.mode == ServoMode::Effort) return set.acting - set.end;
  return law.derivative * (acting_rate(law, set) - (law.mode == ServoMode::Velocity ? set.end : set.rate_at_end));
}

double integral_at_end(const ServoLaw& law, const ServoInput& input, double increment, double excess,
                       const ServoState& state) {
  const double h = input.measured.step;
  const double error = error_at_begin(law, state, input), s = set_increment(law, input) - increment;
  const bool is_velocity = law.mode == ServoMode::Velocity;
  const double integral = state.integral + (is_velocity ? s : h * (error + 0.5 * s));
  if (!calculates_back(law)) return integral;
  // Back-calculation against windup: the integral changes such that the demanded effort follows the saturated one.
  const double lag = integral_share(input) * h / law.tracking_time;
  return integral + h * excess / (integral_gain(law) * law.tracking_time * (1 + lag));
}

double servo_effort(const ServoLaw& law, const ServoInstant& at) {
  if (law.mode == ServoMode::Effort) return at.feedforward + at.set_point;
  const bool is_velocity = law.mode == ServoMode::Velocity;
  const double error = is_velocity ? at.integral : at.set_point - at.measured;
  const double error_rate = (is_velocity ? at.set_point : at.set_rate) - at.rate;
  return at.feedforward + law.proportional * error + law.derivative * error_rate + law.integral * at.integral;
}

double integral_rate(const ServoLaw& law, const ServoInstant& at, double excess) {
  if (law.mode == ServoMode::Effort) return 0;
  const double rate = at.set_point - (law.mode == ServoMode::Velocity ? at.rate : at.measured);
  return calculates_back(law) ? rate + excess / (integral_gain(law) * law.tracking_time) : rate;
}

void advance(const ServoLaw& law, const ServoInput& input, double increment, double excess, ServoState& state) {
  const double h = input.measured.step;
  if (h == 0) return;
  const double s = set_increment(law, input) - increment;
  state.integral = integral_at_end(law, input, increment, excess, state);
  if (input.relaxation == 0) {  // what strikes in the step has not to be followed later
    state.delayed_rate -= input.rate_offset + input.rate_slope * increment - input.begin_rate;
    return;
  }
  const NumericalDissipation d = numerical_dissipation(2, kStiffRemainder, input.relaxation);
  state.average += d.forgetting * (s - state.average);
  const double mean = (2 * input.relaxation * state.delayed_rate - increment) / (h + 2 * input.relaxation);
  state.delayed_rate = 2 * mean - state.delayed_rate;
}

void settle(double measured, double output, ServoState& state) {
  state.average = state.delayed_rate = 0;
  state.measured = measured;
  std::fill(state.outputs.begin(), state.outputs.end(), output);
}

double hand_to_integral(const ServoLaw& law, double error, ServoState& state) {
  if (law.mode != ServoMode::Position || law.integral == 0) return 0;
  state.integral += law.proportional * error / law.integral;
  return std::abs(error);
}

// ---------------------------------------------------------------- sampled controllers

std::size_t outputs_of(const Servo& servo) {
  return servo.sample_time > 0 ? 2 + static_cast<std::size_t>(std::ceil(servo.delay / servo.sample_time)) : 0;
}

void sample(const Servo& servo, const SampledInput& input, ServoState& state) {
  assert(servo.sample_time > 0 && state.outputs.size() == outputs_of(servo));
  const double period = servo.sample_time;
  if (input.time < state.samples * period - input.tolerance) return;
  const ServoLaw& law = law_of(servo, state);
  const double rate = (input.measured - state.measured) / period;
  ServoInstant at{input.set_point, input.set_rate, input.measured, rate, 0, input.feedforward};
  state.integral += period * integral_rate(law, at, 0);
  at.integral = state.integral;
  const double output = servo_effort(law, at);
  const double cut = std::clamp(output, -servo.effort_limit, servo.effort_limit);
  if (calculates_back(law)) state.integral += period * (cut - output) / (integral_gain(law) * law.tracking_time);
  std::rotate(state.outputs.begin(), state.outputs.end() - 1, state.outputs.end());
  state.outputs.front() = cut;
  state.measured = input.measured;
  ++state.samples;
}

double held_output(const Servo& servo, const ServoState& state, double time, double step) {
  assert(servo.sample_time > 0 && state.outputs.size() == outputs_of(servo));
  assert(step > 0 && "what is sampled is not for steps backwards");
  double sum = 0;
  for (std::size_t i = 0; i < state.outputs.size(); ++i) {
    const double number = state.samples - 1 - static_cast<double>(i);  // of the sample; < 0: before the first one
    const double from = number * servo.sample_time + servo.delay;
    const double until = i == 0 ? time + step : from + servo.sample_time;
    const double part = (std::min(time + step, until) - std::max(time, from)) / step;
    if (part > kRoundOff) sum += state.outputs[i] * (part > 1 - kRoundOff ? 1.0 : part);
  }
  return sum;
}

}  // namespace flexarm
