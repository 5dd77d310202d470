#pragma once
/// Access to the inside of a simulation, for the core's own rooms, tests and benchmarks, not for users of the library.

#include <optional>
#include <vector>

#include "building/rigid_lines.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

class StepFollower;
struct MechanismMotion;

const Model& model_of(const Simulation& simulation);
const State& state_of(const Simulation& simulation);
/// The scheme in use. Its constants that depend on the step are those of the first step (see
/// Simulation::set_step_size()), or of set_step_of_constants(), so that make_scheme(simulation.scene().integrator) may
/// return a different scheme.
const Scheme& scheme_of(const Simulation& simulation);
/// The integrator with which that scheme was made and the initial state was found.
const IntegratorDescription& first_integrator_of(const Simulation& simulation);
/// Per link: the line of a beam without elements. Empty for all other links.
const std::vector<std::optional<RigidLine>>& rigid_lines_of(const Simulation& simulation);
/// Which results of the present state exist. Each is computed when it is first requested, and kept until the state
/// changes.
struct MadeForOutput {
  bool rates, velocities, accelerations;  ///< of joint coordinates, of nodes, of probes
  bool energies, momenta;
  bool is_nothing() const { return !(rates || velocities || accelerations || energies || momenta); }
};
MadeForOutput made_for_output(const Simulation& simulation);
/// Velocities of the nodes for output, as Simulation::velocity(): {v, w} in world axes [m/s, rad/s].
const std::vector<Vector6>& node_velocities_of(const Simulation& simulation);
/// Update norms of the last Newton solve, for tests of the rate of convergence.
const std::vector<double>& update_norms_of(const Simulation& simulation);

/// Appends what a force element of the model outputs for the present state.
void put_out_force(const Simulation& simulation, std::size_t element, std::vector<double>& values);

/// Appends for each pair of Model::touching_pairs the force on the first body in world axes [N], the number of points
/// that touch, and the smallest gap [m].
void put_out_touch(const Simulation& simulation, std::size_t pair, std::vector<double>& values);

/// The initial state, with what the scheme stores there.
const State& initial_state_of(const Simulation& simulation);
/// Lets `follower` take part in all further steps of the simulation; null: none.
void accompany(Simulation& simulation, StepFollower* follower);
/// Replaces the state, without any check, by one of a simulation with an equal model, so that results can be read from
/// it.
void show(const State& state, Simulation& simulation);
/// Takes samples of sensors in a state of a simulation with an equal model: of all sensors, or only of those that are
/// due.
void take_samples(State& state, Simulation& simulation, bool all);
/// The state in which the simulation would start if it started with this motion.
State start_at(const Simulation& simulation, const MechanismMotion& motion);

/// Replaces the state by any one that the simulator could have reached, such as one read from a file.
/// @throws std::invalid_argument if it is not a state of this simulation, which then stays as it is
void restore(Simulation& simulation, const State& state);

/// Gives the simulation a meaningless state of a mesh with these halvings, whose lists have the right sizes.
/// @throws std::invalid_argument if its beams cannot be halved like this; it then stays as it is
void take_mesh(Simulation& simulation, const std::vector<HalvedElement>& halved);

/// Sets the length of the next steps [s], whatever the sample times of servos, and how they look for events.
void set_step(Simulation& simulation, double step, const EventSearch& events);
/// Sets the time, which must differ from the present one by round-off only [s].
void correct_time(Simulation& simulation, double time);
/// The step from which the scheme has its constants (take_constants_of_step()) [s]: that of the scene, unless
/// set_step_of_constants() has set another.
double step_of_constants(const Simulation& simulation);
/// Gives the scheme the constants of this step [s]. What dampers store of the motion changes with them; the difference
/// is dissipated, or is work.
void set_step_of_constants(Simulation& simulation, double step);
/// Lets the scheme forget the forces from before an event that the last step has ended at. The next step will have this
/// length [s].
void begin_anew(Simulation& simulation, double step);
/// For a step that ended as StepResult::Reason::EventWithin: time of the event from the beginning of the step [s].
double event_of(const Simulation& simulation);

/// The commands that a simulation got from outside. Those to servos are per actuator.
struct Commands {
  std::vector<double> efforts;
  std::vector<NodalLoad> wrenches;
  std::vector<ServoCommand> servos;
};

/// Copies the present commands of a simulation to `commands`, whose memory is reused.
void take_commands(const Simulation& simulation, Commands& commands);
/// Gives these commands to a simulation of the same model.
void give_commands(const Commands& commands, Simulation& simulation);

}  // namespace flexarm
