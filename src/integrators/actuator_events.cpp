/// The event search of Actuators: when motors, gears and their friction change the equations within a step.
/// (docs/notes/accuracy.md 4)

#include "integrators/actuators.h"
#include "joints/joint_forces.h"
#include "joints/set_points.h"

namespace flexarm {
namespace {

/// Functions of time may jump at the ends of a step. So they are evaluated this fraction of the step inside of it.
constexpr double kInside = 1e-6;

}  // namespace

void Actuators::note_events(FirstEvent& first) {
  if (!parts_.empty()) configuration_.find_begin_rates();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    note_limits(i, first);
    const Actuator& actuator = configuration_.model().actuators[i];
    if (!actuator.drive.gear) continue;
    note_play(i, first);
    const RotorStep& rotor = parts_[i].rotor;
    if (!actuator.drive.sticks || rotor.rests) continue;
    const double rate = configuration_.state().actuators[i].rate;
    const double end_rate = rotor.rate_offset + rotor.rate_slope * parts_[i].action.increment;
    if (parts_[i].action.is_stopped || rate * end_rate <= 0) first.note_stop(kUnknownStop);
  }
}

bool Actuators::turn_too_fast(double refinement) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Drive& drive = configuration_.model().actuators[i].drive;
    if ((drive.friction == 0 || drive.sticks) && drive.loss == 0) continue;
    const RotorStep& rotor = parts_[i].rotor;
    const double end_rate = rotor.rate_offset + rotor.rate_slope * (parts_[i].action.increment + parts_[i].carried);
    if (is_coarse_turn(configuration_.state().actuators[i].rate, end_rate, refinement)) return true;
  }
  return false;
}

void Actuators::note_play(std::size_t index, FirstEvent& first) {
  const Actuator& actuator = configuration_.model().actuators[index];
  const double play = 0.5 * actuator.drive.gear->backlash;
  if (play == 0) return;
  const Part& part = parts_[index];
  const ActuatorState& state = configuration_.state().actuators[index];
  const Coordinate& coordinate = configuration_.model().coordinates[actuator.coordinate];
  const double twist = state.angle - configuration_.coordinate_step(actuator.coordinate, 0).begin;
  const double end = twist + part.action.increment - part.link;
  const double link_rate = configuration_.begin_rates(coordinate.joint)[coordinate.component];
  const double start = configuration_.step() * (state.rate - link_rate);
  first.note(crossing(twist, end, play, start));
  first.note(crossing(twist, end, -play, start));
}

void Actuators::note_limits(std::size_t index, FirstEvent& first) const {
  const Actuator& actuator = configuration_.model().actuators[index];
  const Part& part = parts_[index];
  const bool is_moved = configuration_.model().coordinates[actuator.coordinate].motion >= 0;
  const double limit = std::min(part.demand.limit, actuator.drive.effort_limit);
  if (is_moved || limit == Drive::kInfinity) return;
  const ActuatorState& state = configuration_.state().actuators[index];
  const RotorStep& rotor = part.rotor;
  const double end_rate = rotor.rate_offset + rotor.rate_slope * (part.action.increment + part.carried);
  const MotorRange begin = motor_range(actuator.drive, part.demand.limit, state.rate);
  const MotorRange end = motor_range(actuator.drive, part.demand.limit, end_rate);
  const double at_begin = demand_at(index, 0), at_end = demand_at(index, 1);
  const auto note = [&](double before, double after) { first.note_kink(crossing(before, after, 0, after - before)); };
  note(at_begin - begin.highest, at_end - end.highest);
  note(at_begin - begin.lowest, at_end - end.lowest);
}

/// The effort that is demanded from the motor at the beginning of the step (`end` = 0) or at its end (1).
double Actuators::demand_at(std::size_t index, int end) const {
  const Model& model = configuration_.model();
  const Actuator& actuator = model.actuators[index];
  const Part& part = parts_[index];
  const double step = configuration_.step(), time = configuration_.state().time;
  const double instant = time + (end == 0 ? kInside : 1 - kInside) * step;
  const Coordinate& coordinate = model.coordinates[actuator.coordinate];
  const double commanded = configuration_.state().commands[actuator.coordinate];
  const double of_scene = coordinate.effort < 0 ? 0 : model.histories[coordinate.effort](instant);
  const double effort = applied_effort(coordinate, commanded, of_scene);
  if (!actuator.servo) return effort;
  if (actuator.servo->sample_time > 0) return part.action.demand;  // constant over the step, except for `effort`
  const Servo& servo = *actuator.servo;
  const ServoState& state = configuration_.state().actuators[index].servo;
  const ServoLaw& law = law_of(servo, state);
  const double increment = servo.on_link ? part.link : part.action.increment;
  ServoInstant at;
  set_point_at(servo, state, end, at);
  at.measured = part.input.measured.begin + end * increment;
  at.rate = end == 0 ? part.input.begin_rate : part.input.rate_offset + part.input.rate_slope * increment;
  at.integral = state.integral;
  if (end == 1)
    at.integral = integral_at_end(law, part.input, increment, part.action.motor - part.action.demand, state);
  if (servo.feedforward >= 0) at.feedforward = model.histories[servo.feedforward](instant);
  return effort + servo_effort(law, at);
}

/// Sets the set point at an end of the step and its rate, from a parabola through three instants of the step.
void Actuators::set_point_at(const Servo& servo, const ServoState& state, int end, ServoInstant& at) const {
  const double begin = configuration_.state().time, step = configuration_.step();
  const auto value = [&](double part) {
    return flexarm::set_point_at(configuration_.model(), servo, state, begin + part * step);
  };
  const double first = value(kInside), middle = value(0.5), last = value(1 - kInside);
  at.set_point = end == 0 ? first : last;
  at.set_rate = (end == 0 ? 4 * middle - 3 * first - last : 3 * last - 4 * middle + first) / step;
}

}  // namespace flexarm
