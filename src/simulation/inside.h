#pragma once
/// Access to the inside of a simulation for the core's own rooms, tests and benchmarks, not for users of the library.

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
/// The scheme in use. What of it depends on the step is as it was made at the beginning, see
/// Simulation::set_step_size(); make_scheme(simulation.scene().integrator) may be another one.
const Scheme& scheme_of(const Simulation& simulation);
/// By which that was made, and the initial state found.
const IntegratorDescription& first_integrator_of(const Simulation& simulation);
/// Per link; empty for those that have no beam, or one with elements.
const std::vector<std::optional<RigidLine>>& rigid_lines_of(const Simulation& simulation);
/// What of the present state somebody has asked for: it is made then, and kept until the state changes.
struct MadeForOutput {
  bool rates, velocities, accelerations;  ///< of joint coordinates, of nodes, of probes
  bool energies, momenta;
  bool is_nothing() const { return !(rates || velocities || accelerations || energies || momenta); }
};
MadeForOutput made_for_output(const Simulation& simulation);
/// Update norms of the last Newton solve, for tests of the rate of convergence.
const std::vector<double>& update_norms_of(const Simulation& simulation);

/// Appends what a force element of the model puts out of the present state.
void put_out_force(const Simulation& simulation, std::size_t element, std::vector<double>& values);

/// For each of Model::touching_pairs appends the force on the first body in world axes [N], the number of points that
/// touch, and the smallest gap [m].
void put_out_touch(const Simulation& simulation, std::size_t pair, std::vector<double>& values);

/// Where a simulation starts, with what the scheme keeps there.
const State& initial_state_of(const Simulation& simulation);
/// Takes somebody along with the steps of a simulation from now on; null: nobody.
void accompany(Simulation& simulation, StepFollower* follower);
/// Puts any state of a simulation of a like model in the place of its own, so that it is looked at.
void show(const State& state, Simulation& simulation);
/// Lets sensors measure in a state of a simulation of a like model: all of them, or those of which a sample is due.
void take_samples(State& state, Simulation& simulation, bool all);
/// The state in which a simulation would start in this motion.
State start_at(const Simulation& simulation, const MechanismMotion& motion);

/// Replaces the state by any that the simulator could have come to, as one read from a file.
/// @throws std::invalid_argument if it is not one of this simulation's; which is as before then
void restore(Simulation& simulation, const State& state);

/// The length of the next steps [s], whatever servos sample, and how they look for events.
void set_step(Simulation& simulation, double step, const EventSearch& events);
/// For a step that ended as StepResult::Reason::EventWithin: time of the event from the beginning of the step [s].
double event_of(const Simulation& simulation);

/// What a simulation is told from outside; to servos by actuators.
struct Commands {
  std::vector<double> efforts;
  std::vector<NodalLoad> wrenches;
  std::vector<ServoCommand> servos;
};

/// What holds in a simulation, in the memory of `commands`.
void take_commands(const Simulation& simulation, Commands& commands);
/// Tells another one of the same model the same.
void give_commands(const Commands& commands, Simulation& simulation);

}  // namespace flexarm
