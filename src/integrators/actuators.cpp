#include "integrators/actuators.h"

#include <algorithm>
#include <cmath>

#include "flexarm/model/model_error.h"
#include "joints/elasticity.h"
#include "joints/set_points.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// A rotor that moves by less than this over a step counts as being at rest [rad or m].
constexpr double kAtRest = 1e-12;
/// Fraction of a step by which its end, a sum of steps, may miss a given time because of round-off.
constexpr double kRoundOff = 1e-6;
/// Time before the end of a step that counts as an instant, relative to the step: far more than kRoundOff.
constexpr double kInstant = 1e-3;
/// Relative to a step of the scene: shorter steps are for what strikes, in which nothing relaxes.
constexpr double kStrike = 1e-3;

}  // namespace

Actuators::Actuators(StepConfiguration& configuration, const StepHistories& histories, JointEfforts& efforts)
    : configuration_(configuration),
      histories_(histories),
      efforts_(efforts),
      parts_(configuration.model().actuators.size()),
      gyroscope_of_(configuration.model().joints.size(), -1) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Model& model = configuration.model();
    const Actuator& actuator = model.actuators[i];
    check(actuator);
    if (actuator.gyroscope && !configuration.scheme().is_static)
      gyroscope_of_[model.coordinates[actuator.coordinate].joint] = static_cast<int>(i);
    if (!actuator.servo) continue;
    parts_[i].servo.outputs.resize(outputs_of(*actuator.servo));
    if (actuator.drive.gear && actuator.servo->on_link) configuration.keep_begin_rates();
  }
}

void Actuators::check(const Actuator& actuator) const {
  const Scheme& scheme = configuration_.scheme();
  const std::string joint = " of joint '" + configuration_.model().coordinates[actuator.coordinate].name + "'";
  const std::string backwards =
      "<integrator>: scheme '" + std::string(scheme.name) + "' also steps backwards in time, where ";
  if (scheme.is_composition && actuator.drive.sticks)
    throw ModelError(backwards + "friction of the law 'coulomb' (<drive>" + joint +
                     ") would add energy; take another scheme or the law 'smooth'");
  if (actuator.gyroscope && !scheme.is_incremental() && !scheme.is_static)
    throw ModelError("<integrator>: scheme '" + std::string(scheme.name) +
                     "' has no gyroscopic effect of rotors (axis of <drive>" + joint +
                     "); take one of the energy-momentum family, or leave the axis out");
  if (scheme.is_composition && actuator.servo && actuator.servo->sample_time > 0)
    throw ModelError(backwards + "nothing can be sampled (<servo>" + joint + "); take another scheme");
}

RotorStep Actuators::rotor_step(const Actuator& actuator, const ActuatorState& state) const {
  const Scheme& scheme = configuration_.scheme();
  const double h = configuration_.step();
  RotorStep out;
  out.change = configuration_.coordinate_step(actuator.coordinate, 0);
  out.change.begin = state.angle;
  if (h == 0) return out;
  out.change.begin_rate = state.rate;
  out.rests = state.rest > 0 || std::abs(h * state.rate) <= kAtRest;
  const double rate = state.rate, acceleration = state.acceleration;
  if (scheme.is_incremental()) {
    const double factor = scheme.velocity_factor();
    out.rate_offset = -(factor - 1) * rate;
    out.rate_slope = factor / h;
    out.acceleration_offset = (out.rate_offset - rate) / h;
    out.acceleration_slope = out.rate_slope / h;
    return out;
  }
  const double slope = 1 / (scheme.beta * h * h);
  const double offset = -(rate / (scheme.beta * h) + (0.5 / scheme.beta - 1) * acceleration);
  out.rate_offset = rate + h * ((1 - scheme.gamma) * acceleration + scheme.gamma * offset);
  out.rate_slope = h * scheme.gamma * slope;
  // The balance of a rotor holds at the end of the step. In the Hilber-Hughes-Taylor family the scheme's accelerations
  // belong to an earlier instant. So inertia uses the weighted mean of both, as Wood, Bossak and Zienkiewicz have it.
  const double weight = 1 / configuration_.effort_weight();
  out.acceleration_offset = weight * offset + (1 - weight) * acceleration;
  out.acceleration_slope = weight * slope;
  return out;
}

void Actuators::begin() {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    Part& part = parts_[i];
    const ActuatorState& state = configuration_.state().actuators[i];
    part.rotor = rotor_step(actuator, state);
    part.demand = {};
    if (coordinate.motion < 0) {
      const StepForce& effort = efforts_.of(actuator.coordinate);
      part.demand.constant = effort.acting;
      part.demand.surplus = effort.acting - effort.at_end;
    }
    if (actuator.servo && coordinate.motion < 0) ask(actuator, state, part);
    if (state.servo.off > 0) part.demand = {0, 0, 0, 0, 0};  // a servo that is off still measures
    part.action = {};
    part.action.increment = configuration_.step() * state.rate;
  }
}

double Actuators::rate_of_command(const ServoState& state, double time) const {
  return state.set_rate_at(time, kRoundOff * configuration_.step());
}

SetPoint Actuators::commanded_set_point(const ServoState& state) const {
  if (configuration_.scheme().is_static) return {state.set_point, state.set_point};
  const double begin = configuration_.state().time, end = configuration_.end_time();
  SetPoint out(state.set_point_at(begin), state.set_point_at(end));
  out.rate_at_end = out.acting_rate = rate_of_command(state, end);
  return out;
}

SetPoint Actuators::set_point(const Servo& servo, const ServoState& state) const {
  if (!std::isnan(state.set_point)) return commanded_set_point(state);
  if (servo.set_point < 0) return {servo.start, servo.start};
  const TimeFunction& history = configuration_.model().histories[servo.set_point];
  const Scheme& scheme = configuration_.scheme();
  if (scheme.is_static) return {history(0), history(0)};
  const double step = configuration_.step(), begin = configuration_.state().time, end = configuration_.end_time();
  SetPoint out(set_point_at_border(history, begin, step), set_point_at_border(history, end, step));
  out.mean = histories_.of_servo(servo.set_point).mean;
  out.acting = histories_.of_servo(servo.set_point).acting;
  if (scheme.is_incremental() || law_of(servo, state).mode != ServoMode::Position) return out;
  // If the set point jumps, its rate is an impulse.
  out.rate_at_end = history.derivative(end);
  const double mean_rate = (out.end - out.begin) / step;
  out.acting_rate = out.rate_at_end + mean_rate - 0.5 * (history.derivative(begin) + out.rate_at_end);
  return out;
}

ServoInput Actuators::servo_input(const Actuator& actuator, const Part& part, const ActuatorState& state) const {
  const Scheme& scheme = configuration_.scheme();
  const Servo& servo = *actuator.servo;
  ServoInput input;
  input.time = configuration_.state().time;
  input.measured = part.rotor.change;
  input.begin_rate = state.rate;
  input.rate_offset = part.rotor.rate_offset;
  input.rate_slope = part.rotor.rate_slope;
  if (actuator.gyroscope) {
    const Gyroscope& gyroscope = *actuator.gyroscope;
    input.begin_rate -=
        gyroscope.axis.dot(configuration_.state().nodes[gyroscope.node].angular_velocity) / gyroscope.ratio;
  }
  if (servo.on_link) {
    const Coordinate& coordinate = configuration_.model().coordinates[actuator.coordinate];
    input.measured = configuration_.coordinate_step(actuator.coordinate, 0);
    input.measured.begin = input.measured.end - configuration_.increment_of(coordinate);
    if (actuator.drive.gear && configuration_.step() != 0) {
      const CoordinateStep& change = input.measured;
      input.begin_rate = configuration_.begin_rates(coordinate.joint)[coordinate.component];
      input.rate_offset = -(1 - change.gamma) * input.begin_rate / change.gamma;
      input.rate_slope = rate_slope(change);
    }
  }
  input.set_point = set_point(servo, state.servo);
  if (servo.feedforward >= 0) input.feedforward = histories_.factor * histories_.of_servo(servo.feedforward).acting;
  // In a composition, the errors of the sub-steps cancel only if all sub-steps use the same rule. So there is no
  // relaxation.
  const double step = configuration_.step(), of_scene = scheme.blur;
  if (scheme.is_incremental() && !scheme.is_composition && !scheme.is_static && step > kStrike * of_scene)
    input.relaxation = std::min(of_scene, step);
  return input;
}

StepForce Actuators::held_effort(const Servo& servo, const ServoState& before, const ServoState& now) const {
  const double time = configuration_.state().time, step = configuration_.step();
  const double mean = held_output(servo, now, time, step);
  if (configuration_.scheme().is_incremental()) return {mean, mean, mean};
  const double instant = kInstant * step;
  return StepForce::at_points(mean, held_output(servo, before, time - instant, instant),
                              held_output(servo, now, time + step - instant, instant));
}

void Actuators::ask(const Actuator& actuator, const ActuatorState& state, Part& part) const {
  const Servo& servo = *actuator.servo;
  part.demand.limit = servo_limit(configuration_.model(), actuator);
  part.input = servo_input(actuator, part, state);
  if (servo.sample_time > 0 && configuration_.step() != 0) {
    const double time = part.input.time, step = configuration_.step();
    part.servo = state.servo;
    sample(servo,
           sampled_input(configuration_.model(), servo, state.servo, part.input.measured.begin, time, kRoundOff * step),
           part.servo);
    const StepForce held = held_effort(servo, state.servo, part.servo);
    part.demand.constant += held.acting;
    part.demand.surplus += held.acting - held.at_end;
    return;
  }
  const ServoLaw& law = law_of(servo, state.servo);
  const ServoDemand asked = servo_demand(law, state.servo, part.input);
  part.demand.constant += asked.constant;
  part.demand.surplus += servo_surplus(law, part.input);
  if (servo.feedforward >= 0) {
    const StepForce& feedforward = histories_.of_servo(servo.feedforward);
    part.demand.surplus += histories_.factor * (feedforward.acting - feedforward.at_end);
  }
  (servo.on_link ? part.demand.by_link : part.demand.by_rotor) += asked.slope;
}

PassiveEffort Actuators::spring_effort(const JointSpring& spring, const CoordinateStep& link) const {
  CoordinateStep stretch = link;
  stretch.begin -= spring.rest;
  stretch.end -= spring.rest;
  return elastic_effort(spring.elasticity, stretch);
}

void Actuators::turn_carrier(const Gyroscope& gyroscope, Part& part) const {
  const Matrix3& begin = configuration_.begin()[gyroscope.node].rotation;
  const Vector3& increment = configuration_.increments()[gyroscope.node];
  const Vector3 axis = begin * gyroscope.axis;
  part.carried = axis.dot(increment) / gyroscope.ratio;
  part.carried_by_spin = cayley::inverse_tangent(increment).transpose() * axis / gyroscope.ratio;
}

/// A rotor with the momentum p about the axis a changes the momentum of its carrier by (p_1 a_1 - p_0 a_0)/h.
void Actuators::add_moment(const Gyroscope& gyroscope, const ActuatorState& state, Part& part, Balance& balance) const {
  const double h = configuration_.step(), inertia = gyroscope.inertia * gyroscope.ratio;
  const Vector3 begin = configuration_.begin()[gyroscope.node].rotation * gyroscope.axis;
  const Vector3 end = configuration_.end()[gyroscope.node].rotation * gyroscope.axis;
  const MotorAction& action = part.action;
  const double momentum =
      inertia * (part.rotor.rate_offset + part.rotor.rate_slope * (action.increment + part.carried));
  balance.residual.node(gyroscope.node).tail<3>() += (momentum * end - inertia * state.rate * begin) / h;
  if (!balance.tangent) return;
  const Vector3 by_increment = (inertia * part.rotor.rate_slope / h) * end;
  part.moment_by_link = action.follows * by_increment;
  Matrix6 tangent = Matrix6::Zero();
  tangent.bottomRightCorner<3, 3>() =
      (1 + action.increment_by_load * part.load_by_carried) * by_increment * part.carried_by_spin.transpose() -
      (momentum / h) * so3::hat(end);
  balance.tangent->add_to_node(gyroscope.node, tangent);
}

void Actuators::add_gyroscope(int joint, FoldMaps& maps) const {
  const int index = gyroscope_of_[joint];
  if (index < 0) return;
  const Part& part = parts_[index];
  maps.released_spin.row(0) -= configuration_.effort_weight() * part.action.effort_by_load * part.load_by_carried *
                               part.carried_by_spin.transpose();
  maps.moment_released.col(0) += part.moment_by_link;
}

void Actuators::evaluate(Balance& balance) {
  const Model& model = configuration_.model();
  const double weight = configuration_.effort_weight();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const CoordinateStep link =
        configuration_.coordinate_step(actuator.coordinate, configuration_.increment_of(coordinate));
    Part& part = parts_[i];
    part.link = link.increment;
    RotorStep rotor = part.rotor;
    const bool is_gyroscope = gyroscope_of_[coordinate.joint] == static_cast<int>(i);
    if (is_gyroscope) {
      turn_carrier(*actuator.gyroscope, part);
      rotor.acceleration_offset += rotor.acceleration_slope * part.carried;
      part.load_by_carried = actuator.drive.inertia * rotor.acceleration_slope;
    }
    part.action = holds_rotors_ && actuator.drive.gear
                      ? held_motor_action(actuator.drive, part.demand, rotor, link)
                      : motor_action(actuator.drive, part.demand, rotor, link, part.action.increment);
    if (has_motor(coordinate))
      efforts_.set_motor(actuator.coordinate, part.action.motor, part.action.motor_at_end, part.action.increment);
    if (is_gyroscope) add_moment(*actuator.gyroscope, configuration_.state().actuators[i], part, balance);
    const PassiveEffort spring = actuator.spring ? spring_effort(*actuator.spring, link) : PassiveEffort();
    balance.dissipated += part.action.dissipated + spring.dissipated;
    const int variable = configuration_.degrees_of_freedom().variable_of_joint(coordinate.joint);
    const int k = coordinate.component;
    balance.residual.at(variable)[k] -= weight * (part.action.effort + spring.effort);
    if (!balance.tangent) continue;
    const int count = released_count(model.joints[coordinate.joint].kind);
    balance.tangent->diagonal_block(variable)[k * count + k] -= weight * (part.action.slope + spring.slope);
  }
}

void Actuators::accept(State& state) const {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    const RotorStep& rotor = part.rotor;
    const MotorAction& action = part.action;
    const Actuator& actuator = model.actuators[i];
    ActuatorState& own = state.actuators[i];
    if (actuator.servo && configuration_.step() == 0) {
      const double increment = actuator.servo->on_link ? part.link : action.increment;
      const ServoDemand asked = servo_demand(law_of(*actuator.servo, own.servo), own.servo, part.input);
      const double limit = actuator.servo->effort_limit;
      settle(part.input.measured.begin + increment, std::clamp(asked.constant + asked.slope * increment, -limit, limit),
             own.servo);
    } else if (actuator.servo && actuator.servo->sample_time > 0) {
      own.servo = part.servo;
    } else if (actuator.servo) {
      advance(law_of(*actuator.servo, own.servo), part.input, actuator.servo->on_link ? part.link : action.increment,
              action.motor - action.demand, own.servo);
    }
    if (own.servo.off > 0) own.servo.integral = 0;
    own.angle += action.increment;
    own.rate = rotor.rate_offset + rotor.rate_slope * (action.increment + part.carried);
    if (!configuration_.scheme().is_incremental()) {
      const double weight = configuration_.scheme().is_static ? 1 : 1 / configuration_.effort_weight();
      const double mean = rotor.acceleration_offset + rotor.acceleration_slope * action.increment;
      own.acceleration = (mean - (1 - weight) * own.acceleration) / weight;
    }
    own.rest = action.is_stopped ? 1 : 0;
  }
}

double Actuators::hand_to_integrals(State& state) const {
  const Model& model = configuration_.model();
  double largest = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Actuator& actuator = model.actuators[i];
    if (!actuator.servo || model.coordinates[actuator.coordinate].motion >= 0) continue;
    ServoState& servo = state.actuators[i].servo;
    if (servo.off > 0) continue;
    const double error = set_point(*actuator.servo, servo).end - servo.measured;
    largest = std::max(largest, hand_to_integral(law_of(*actuator.servo, servo), error, servo));
  }
  return largest;
}

}  // namespace flexarm
