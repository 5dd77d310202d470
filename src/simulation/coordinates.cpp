// Joint coordinates of a Simulation: what they do, and commands to them and to their servos.
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexarm/simulation/command_refusal.h"
#include "flexarm/simulation/simulation.h"
#include "math/so3.h"
#include "math/step_end.h"
#include "model/carried_origin.h"
#include "simulation/entry.h"
#include "simulation/implementation.h"
#include "simulation/joint_state.h"
#include "simulation/servo_commands.h"

namespace flexarm {
namespace {

/// If the coordinate has no servo because it is prescribed or follows another one, throws std::invalid_argument that
/// says so. Where only a servo is missing, the functions that look up servos throw an error.
void require_own_servo(const Simulation& simulation, std::size_t index) {
  if (!simulation.has_servo(index) && !simulation.is_commandable(index))
    throw std::invalid_argument(refusal_of_commands(simulation, index));
}

}  // namespace

const std::vector<std::string>& Simulation::coordinate_names() const {
  return implementation_->coordinate_names;
}

std::optional<std::size_t> Simulation::find_coordinate(std::string_view name) const {
  const auto found = implementation_->coordinate_indices.find(name);
  return found == implementation_->coordinate_indices.end() ? std::nullopt : std::optional(found->second);
}

double Simulation::position(std::size_t index) const {
  const Coordinate& coordinate = entry(implementation_->model.coordinates, index, "joint coordinate");
  const Released& released = implementation_->state.released[coordinate.joint];
  if (!coordinate.is_angle) {
    const JointMap& joint = implementation_->model.joints[coordinate.joint];
    return carried_translation(joint, implementation_->state)[coordinate.component] +
           released.displacement[coordinate.component];
  }
  return so3::log(released.rotation)[coordinate.component % 3];
}

double Simulation::velocity(std::size_t index) const {
  return implementation_->published.rates(implementation_->view())
      .rate(entry(implementation_->model.coordinates, index, "joint coordinate"));
}

double Simulation::effort(std::size_t index) const {
  const State& state = implementation_->state;
  const bool is_driven = entry(implementation_->model.coordinates, index, "joint coordinate").motion >= 0;
  return is_driven ? state.drives.at_end(index) : state.efforts[index];
}

void Simulation::command_effort(std::size_t index, double effort) {
  if (!std::isfinite(effort)) throw std::invalid_argument("a commanded effort must be finite");
  if (!is_commandable(index)) throw std::invalid_argument(refusal_of_commands(*this, index));
  implementation_->state.commands[index] = effort;
}

void Simulation::release_command(std::size_t index) {
  entry(implementation_->model.coordinates, index, "joint coordinate");
  implementation_->state.commands[index] = std::numeric_limits<double>::quiet_NaN();
}

void Simulation::command_set_point(std::size_t index, double set_point, double rate, double acceleration) {
  Implementation& s = *implementation_;
  require_own_servo(*this, index);
  flexarm::command_set_point(servo_of(s.model, index, s.state), set_point, rate, acceleration,
                             step_end(s.state.time, s.settings.step));
}

double Simulation::set_point(std::size_t index) const {
  const Implementation& s = *implementation_;
  return flexarm::set_point(servo_of(s.model, index), s.model, servo_of(s.model, index, implementation_->state),
                            step_end(s.state.time, s.settings.step));
}

void Simulation::release_set_point(std::size_t index) {
  flexarm::release_set_point(implementation_->model, index, implementation_->state);
}

void Simulation::switch_servo(std::size_t index, bool on) {
  servo_of(implementation_->model, index, implementation_->state).off = on ? 0 : 1;
}

void Simulation::switch_mode(std::size_t index, ServoMode mode) {
  require_own_servo(*this, index);
  Implementation& s = *implementation_;
  servo_of(s.model, index);
  flexarm::switch_mode(s.model, index, mode, position(index), velocity(index), s.settings.step, s.state);
}

ServoMode Simulation::servo_mode(std::size_t index) const {
  return law_of(servo_of(implementation_->model, index),
                servo_of(implementation_->model, index, implementation_->state))
      .mode;
}

bool Simulation::has_servo(std::size_t index) const {
  return flexarm::has_servo(implementation_->model, index);
}

bool Simulation::is_commandable(std::size_t index) const {
  const Coordinate& coordinate = entry(implementation_->model.coordinates, index, "joint coordinate");
  return coordinate.motion < 0 && coordinate.mimicked < 0;
}

void Simulation::set_joint_state(const std::vector<CoordinateState>& coordinates) {
  Implementation& s = *implementation_;
  State moved = with_joint_state(s.model, s.stepper->degrees_of_freedom(), s.state, coordinates);
  s.begin(moved);
  moved.work += flexarm::energies(s.model, s.scheme, moved).total() - s.published_energies().total();
  s.set_state(moved);
}

}  // namespace flexarm
