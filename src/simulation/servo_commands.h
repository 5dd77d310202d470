#pragma once
/// Commands to servos: set points and modes.

#include <cstddef>

#include "model/model.h"
#include "model/state.h"

namespace flexarm {

bool has_servo(const Model& model, std::size_t coordinate);
/// @throws std::invalid_argument if the coordinate has no servo.
const Servo& servo_of(const Model& model, std::size_t coordinate);
ServoState& servo_of(const Model& model, std::size_t coordinate, State& state);

/// @throws std::invalid_argument if a step of this length [s] does not divide the sample time of a servo.
void require_hit_samples(const Model& model, double step);

/// As Simulation::command_set_point(). `arrival`: end of the next step [s].
void command_set_point(ServoState& servo, double set_point, double rate, double acceleration, double arrival);
/// The set point in force at `time`. A commanded one counts as if it had arrived.
double set_point(const Servo& servo, const Model& model, const ServoState& state, double time);
/// As Simulation::release_set_point().
void release_set_point(const Model& model, std::size_t coordinate, State& state);
/// As Simulation::switch_mode(). `position`, `velocity`: of the coordinate; `step`: of the simulation [s].
void switch_mode(const Model& model, std::size_t coordinate, ServoMode mode, double position, double velocity,
                 double step, State& state);

}  // namespace flexarm
