#include "simulation/inside.h"

#include "analysis/mechanism_states.h"
#include "simulation/implementation.h"
#include "simulation/rebuilt.h"
#include "simulation/touching.h"

namespace flexarm {

struct Inside {
  static Simulation::Implementation& of(const Simulation& simulation) { return *simulation.implementation_; }
  static Simulation with_settings_of(const Simulation& like, scene::SceneDescription scene) {
    const auto& from = of(like);
    scene.integrator = from.first_integrator;
    scene.starts_in_equilibrium = false;
    auto made = std::make_unique<Simulation::Implementation>(std::move(scene), SimulationOptions());
    made->scene.integrator = from.scene.integrator;
    made->settings = from.settings;
    made->stepper = std::make_unique<Stepper>(made->model, made->scheme, made->settings);
    return Simulation(std::move(made));
  }
};

Simulation with_settings_of(const Simulation& like, scene::SceneDescription scene) {
  return Inside::with_settings_of(like, std::move(scene));
}
void begin(Simulation& simulation, State& state) {
  Inside::of(simulation).begin(state);
}

const Model& model_of(const Simulation& simulation) {
  return Inside::of(simulation).model;
}
const State& state_of(const Simulation& simulation) {
  return Inside::of(simulation).state;
}
const Scheme& scheme_of(const Simulation& simulation) {
  return Inside::of(simulation).scheme;
}
const IntegratorDescription& first_integrator_of(const Simulation& simulation) {
  return Inside::of(simulation).first_integrator;
}
const std::vector<std::optional<RigidLine>>& rigid_lines_of(const Simulation& simulation) {
  return Inside::of(simulation).rigid_lines;
}
MadeForOutput made_for_output(const Simulation& simulation) {
  const auto& s = Inside::of(simulation);
  return {s.published.holds_rates(), s.published.holds_velocities(), s.published.holds_past(), s.energies.has_value(),
          s.momenta.has_value()};
}
const std::vector<Vector6>& node_velocities_of(const Simulation& simulation) {
  const auto& s = Inside::of(simulation);
  return s.published.velocities(s.view()).nodes();
}
const std::vector<double>& update_norms_of(const Simulation& simulation) {
  const auto& inside = Inside::of(simulation);
  return inside.static_norms.empty() ? inside.stepper->update_norms() : inside.static_norms;
}
void put_out_force(const Simulation& simulation, std::size_t element, std::vector<double>& values) {
  const auto& s = Inside::of(simulation);
  put_out(element, s.view(), s.published, values);
}
void put_out_touch(const Simulation& simulation, std::size_t pair, std::vector<double>& values) {
  const auto& s = Inside::of(simulation);
  Vector3 force = Vector3::Zero();
  int points = 0;
  const double gap = touch(s.model.touching_pairs.at(pair), s.view(), s.published, [&](const TouchingPoint& point) {
    force += point.push + point.friction;
    ++points;
  });
  values.insert(values.end(), {force.x(), force.y(), force.z(), static_cast<double>(points), gap});
}
const State& initial_state_of(const Simulation& simulation) {
  return *Inside::of(simulation).initial;
}
void accompany(Simulation& simulation, StepFollower* follower) {
  Inside::of(simulation).stepper->accompany(follower);
}
void show(const State& state, Simulation& simulation) {
  auto& inside = Inside::of(simulation);
  inside.state = state;
  inside.forget_published();
}
void take_samples(State& state, Simulation& simulation, bool all) {
  auto& inside = Inside::of(simulation);
  const MotionView view = {inside.model, inside.stepper->degrees_of_freedom(), inside.scheme, state};
  inside.forget_published();
  flexarm::take_samples(inside.scene.sensors, view, inside.published, all, state.samples);
  inside.forget_published();
}
State start_at(const Simulation& simulation, const MechanismMotion& motion) {
  auto& inside = Inside::of(simulation);
  Model placed = inside.model;
  placed.nodes = motion.pose.nodes;
  placed.initial_released = motion.pose.released;
  placed.initial_velocity = motion.rates.nodes;
  State state = initial_state(placed, inside.state.time);
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    if (!placed.actuators[i].drive.gear) continue;  // otherwise the rotor turns with its coordinate
    state.actuators[i].angle = motion.rotors[i];
    state.actuators[i].rate = motion.rates.rotors[i];
  }
  inside.stepper->initialise(state);
  return state;
}
void restore(Simulation& simulation, const State& state) {
  Inside::of(simulation).restore(state);
}

void take_mesh(Simulation& simulation, const std::vector<HalvedElement>& halved) {
  auto& inside = Inside::of(simulation);
  if (const std::string flaw = halving_flaw(inside.model, halved); !flaw.empty()) throw std::invalid_argument(flaw);
  inside.take_mesh(halved);
}

void set_step(Simulation& simulation, double step, const EventSearch& events) {
  Inside::of(simulation).set_step(step, events);
}
void correct_time(Simulation& simulation, double time) {
  Inside::of(simulation).state.time = time;
}
double step_of_constants(const Simulation& simulation) {
  return Inside::of(simulation).step_of_constants;
}
void set_step_of_constants(Simulation& simulation, double step) {
  Inside::of(simulation).set_step_of_constants(step);
}
void begin_anew(Simulation& simulation, double step) {
  auto& inside = Inside::of(simulation);
  if (inside.stepper->begin_anew(inside.state, step)) inside.forget_published();
}
double event_of(const Simulation& simulation) {
  return Inside::of(simulation).stepper->event();
}

void take_commands(const Simulation& simulation, Commands& commands) {
  const State& state = Inside::of(simulation).state;
  commands.efforts = state.commands;
  commands.wrenches = state.wrenches;
  commands.servos.resize(state.actuators.size());
  for (std::size_t i = 0; i < state.actuators.size(); ++i) commands.servos[i] = state.actuators[i].servo;
}

void give_commands(const Commands& commands, Simulation& simulation) {
  State& state = Inside::of(simulation).state;
  state.commands = commands.efforts;
  state.wrenches = commands.wrenches;
  for (std::size_t i = 0; i < state.actuators.size(); ++i)
    static_cast<ServoCommand&>(state.actuators[i].servo) = commands.servos[i];
}

}  // namespace flexarm
