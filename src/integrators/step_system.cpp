#include "integrators/step_system.h"

#include <algorithm>

namespace flexarm {

StepSystem::StepSystem(const Model& model, const Scheme& scheme, BackendChoice backend, Space space)
    : dof_(model),
      configuration_(model, scheme, dof_),
      histories_(model),
      prestrains_(configuration_),
      space_(configuration_, prestrains_, backend, space),
      forces_(configuration_, histories_),
      force_elements_(configuration_, histories_),
      drag_(configuration_),
      loops_(configuration_),
      friction_(configuration_),
      efforts_(configuration_, histories_),
      actuators_(configuration_, histories_, efforts_),
      joints_(configuration_, efforts_, friction_, actuators_),
      reactions_(configuration_, loops_),
      held_efforts_(configuration_, histories_, forces_, reactions_, space_.family_in_space()),
      reversals_(configuration_),
      contacts_(configuration_),
      rows_(model, dof_),
      carried_rows_(model, dof_),
      residual_(Eigen::VectorXd::Zero(dof_.unknowns)),
      nodal_update_(6 * static_cast<std::size_t>(dof_.node_count)),
      scales_(model, dof_) {}

void StepSystem::begin_beside(const StepSystem& other, const State& state, const IncrementHistory& guess) {
  configuration_.lead(other.configuration_.led_to());
  invalidate();
  start(state, other.configuration().step());
  friction_.stick_as(other.friction_);
  move_ahead(guess, 0);
  place_followers();
}

void StepSystem::remember_increments(IncrementHistory& history) const {
  configuration_.remember_increments(history);
  loops_.remember(history);
}

void StepSystem::remember_step(const State& begin, double step, State& end) {
  if (end.history.holds_for(dof_.unknowns)) loops_.extrapolate(end.history);
  configuration_.begin(begin, step);
  configuration_.set_end(end);
  end.history = begin.history;
  remember_increments(end.history);
}

void StepSystem::begin_equilibrium(const State& state, double load_factor, double drag) {
  histories_.factor = load_factor;
  drag_.strength = drag;
  configuration_.begin(state, 0);
  histories_.begin(configuration_);
  prestrains_.begin(load_factor);
  family().begin();
  force_elements_.begin(tangent());
  loops_.begin();
  efforts_.begin();
  actuators_.begin();
  configuration_.set_prescribed(0.0);
  configuration_.set_slaves();
}

void StepSystem::note_events(FirstEvent& first) {
  friction_.note_events(first);
  contacts_.note_events(first);
  actuators_.note_events(first);
  configuration_.note_events(first);
  force_elements_.note_events(first);
}

void StepSystem::carry_strains(double fraction) {
  const double* solution = tangent().expanded_solution();
  if (!solution) return;
  for (std::size_t i = 0; i < nodal_update_.size(); ++i) nodal_update_[i] = fraction * solution[i];
  family().carry_strains(nodal_update_.data());
}

void StepSystem::accept_rest(State& state) {
  family().accept(state);
  joints_.accept(state);
  efforts_.accept(state);
  actuators_.accept(state);
  force_elements_.accept(state);
  std::fill(state.branch_strains.begin(), state.branch_strains.end(), Vector6::Zero());  // all have relaxed
  std::fill(state.strain_memory.begin(), state.strain_memory.end(), StrainMemory());
  state.drives.restart(state.efforts);
  reactions_.accept_rest(rows_, state);
  state.study.come_to_rest();
  state.history.clear();
}

std::vector<Vector6> StepSystem::nodal_forces(const State& state) {
  begin_equilibrium(state, 1);
  rows_.set_zero();
  Balance balance{rows_, nullptr};
  add_forces(balance);
  std::vector<Vector6> forces;
  forces.reserve(dof_.node_count);
  for (int i = 0; i < dof_.node_count; ++i) forces.push_back(rows_.node(i));
  return forces;
}

void StepSystem::initialise(State& state) {
  configuration_.begin(state, 0);
  space_.family_in_space().initialise(state);
}

}  // namespace flexarm
