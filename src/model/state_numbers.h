#pragma once
/// Visits all numbers of a state, for checkpoints and checks. Only this file lists all of them.

#include "model/state.h"

namespace flexarm {

/// Name of the only quantity that may be NaN, which means that there is no command.
constexpr const char* kCommand = "a command";
/// Name of the only quantity that must not be negative.
constexpr const char* kDuration = "the duration of a past step";

/// Calls `visit(what, number)` for every floating-point number of a state, in a fixed order. `what`: name of the
/// quantity for messages. Integers are not visited: halving_level, good_steps, steps, the counts and order of
/// histories, left_lines, halved. `past_steps`: how many past steps have increments; older files have fewer.
template <class AnyState, class Visit>
void for_each_number(AnyState& state, const Visit& visit, std::size_t past_steps = IncrementHistory::kLength) {
  const auto vector = [&](const char* what, auto& v) {
    for (int k = 0; k < v.size(); ++k) visit(what, v[k]);
  };
  visit("the time", state.time);
  vector("the origin", state.origin);
  for (auto& node : state.nodes) {
    vector("a node's position", node.position);
    vector("a node's orientation", node.orientation.coeffs());
    vector("a node's velocity", node.velocity);
    vector("a node's angular velocity", node.angular_velocity);
    vector("a node's mean spin", node.mean_spin);
    vector("a node's acceleration", node.acceleration);
    vector("a node's angular acceleration", node.angular_acceleration);
  }
  for (auto& released : state.released) {
    vector("a joint's displacement", released.displacement);
    vector("a joint's rotation", released.rotation.coeffs());
  }
  for (auto& point : state.study.mass_points) {
    vector("a mass point's angular velocity", point.angular_velocity);
    vector("a mass point's angular acceleration", point.angular_acceleration);
  }
  for (auto& rate : state.study.strain_rates) vector("a strain rate", rate);
  for (auto& strain : state.branch_strains) vector("a strain of a Maxwell element", strain);
  for (auto& command : state.commands) visit(kCommand, command);
  for (auto& wrench : state.wrenches) {
    for (auto* part : {&wrench.arm, &wrench.force, &wrench.moment, &wrench.pull.target})
      vector("an applied wrench", *part);
    for (auto* number : {&wrench.pull.stiffness, &wrench.pull.damping}) visit("the spring of a wrench", *number);
  }
  for (auto& effort : state.efforts) visit("an effort", effort);
  for (auto& rest : state.rests) visit("a mark of rest", rest);
  for (auto& actuator : state.actuators) {
    visit("a rotor's angle", actuator.angle);
    visit("a rotor's rate", actuator.rate);
    visit("a rotor's acceleration", actuator.acceleration);
    visit("a mark of rest", actuator.rest);
    auto& servo = actuator.servo;
    visit(kCommand, servo.set_point);
    for (auto* number : {&servo.set_rate, &servo.set_acceleration, &servo.set_time, &servo.law})
      visit("how a set point moves", *number);
    visit("a mark of what is off", servo.off);
    for (auto* number : {&servo.integral, &servo.average, &servo.delayed_rate, &servo.samples, &servo.measured})
      visit("the memory of a servo", *number);
    for (auto& output : servo.outputs) visit("the memory of a servo", output);
  }
  for (std::size_t i = 0; i < past_steps; ++i)
    for (auto& increment : state.history.increments[i]) visit("an increment", increment);
  for (std::size_t i = 0; i < past_steps; ++i) visit("the length of a past step", state.history.steps[i]);
  for (auto& impulse : state.drives.impulse) visit("the impulse of a motion", impulse);
  for (auto& means : state.drives.means)
    for (auto& mean : means) visit("the effort of a motion", mean);
  for (auto& duration : state.drives.durations) visit(kDuration, duration);
  visit("the work", state.work);
  visit("the dissipated energy", state.dissipated);
  for (auto& memory : state.strain_memory) {
    vector("an average of strain increments", memory.average);
    vector("a strain rate", memory.rate);
    vector("a delayed strain rate", memory.delayed_rate);
  }
  for (auto* points : {&state.study.stiffness_rotations, &state.study.mass_rotations})
    for (auto& point : *points) {
      for (int k = 0; k < 9; ++k) visit("a point's rotation", point.rotation(k / 3, k % 3));
      vector("a point's curvature", point.curvature);
    }
  for (auto& rotation : state.study.total_rotations) vector("a total rotation", rotation);
  for (auto& force : state.study.forces) vector("a nodal force", force);
  for (auto& reaction : state.study.reactions) vector("a reaction", reaction);
  for (auto& rate : state.study.momentum_rates) vector("a momentum rate", rate);
  for (auto& impulse : state.transmitted.impulse) visit("the impulse of a joint", impulse);
  for (auto& means : state.transmitted.means)
    for (auto& mean : means) visit("what a joint transmits", mean);
  for (auto& duration : state.transmitted.durations) visit(kDuration, duration);
  for (auto& force : state.last_transmitted) visit("what a joint transmits", force);
  for (auto& sample : state.samples) {
    visit("the time of a sample", sample.time);
    for (auto& value : sample.values) visit("a sample", value);
  }
  for (auto& number : state.force_memory) visit("the memory of a force element", number);
}

}  // namespace flexarm
