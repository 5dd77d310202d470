// One step from top to bottom, in the order in which it happens: begin, guess, iterate (evaluate, factorise and solve,
// update, revise), accept. Each part of the step has one line here for each of these.
#include <cmath>

#include "integrators/stepper.h"

namespace flexarm {

bool Stepper::simple_step(State& state, double step, StepResult& result) {
  using Factors = NewtonIteration::Factors;
  struct Attempt {
    Guess guess;
    Factors factors;
  };
  const Attempt attempts[] = {
      {Guess::Extrapolated, settings_.reuse_factorisation ? Factors::MayBeKept : Factors::Fresh},
      {Guess::Extrapolated, Factors::Fresh},
      {Guess::Repeated, Factors::Fresh},
      {Guess::Unchanged, Factors::Fresh}};
  result.failure.guesses = 0;
  for (const Attempt& attempt : attempts) {
    const bool is_again = &attempt == &attempts[1];
    if (is_again && !newton_.made_kept_updates()) continue;
    if (attempt.guess == Guess::Repeated && state.history.order == 0) continue;  // the same as Extrapolated
    if (!is_again) ++result.failure.guesses;
    enter(StepPhase::Begin);
    system_.begin(state, step, attempt.guess);
    if (!newton_.solve(NewtonIteration::Updates::Limited, attempt.factors, result)) continue;
    result.reason = flaw_of_solution(state, step, result);
    if (result.reason != StepResult::Reason::None) return false;
    if (follower_) follower_->follow(state, system_);
    enter(StepPhase::Accept);
    system_.accept(state);
    result.other_guesses += attempt.guess != Guess::Extrapolated;
    enter(StepPhase::Control);
    return true;
  }
  return false;
}

// ---------------------------------------------------------------- begin

void StepSystem::begin(const State& state, double step, Guess guess) {
  start(state, step);
  const bool stands = guess == Guess::Extrapolated && state.history.order == IncrementHistory::kNoMotion;
  if (guess != Guess::Unchanged && !stands)
    move_ahead(state.history, guess == Guess::Extrapolated ? state.history.order : 0);
  place_followers();
}

void StepSystem::start(const State& state, double step) {
  configuration_.begin(state, step);
  histories_.begin(configuration_);
  space_.choose(state);
  if (prestrains_.begin(1)) space_.family_in_space().invalidate();
  family().begin();
  force_elements_.begin(space_.tangent_in_space());
  loops_.begin();
  friction_.begin();
  efforts_.begin();
  actuators_.begin();
  reversals_.begin();
}

// ---------------------------------------------------------------- guess

void StepSystem::move_ahead(const IncrementHistory& history, int order) {
  contacts_.before_update();
  configuration_.extrapolate(history, order);
  contacts_.after_update();
  if (history.holds_for(dof_.unknowns)) loops_.extrapolate(history);
}

void StepSystem::place_followers() {
  configuration_.set_prescribed(configuration_.end_time());
  configuration_.set_slaves();
}

// ---------------------------------------------------------------- iterate

StepResult::Reason NewtonIteration::iterate(Updates updates, Factors factors, StepResult& result) {
  norms_.clear();
  if (update_.size() == 0) return evaluate(false);
  const double step = system_.configuration().step();
  bool makes_new = factors == Factors::Fresh;  // whether each iteration makes new factors
  Progress progress;
  bool factorise = makes_new || factor_reuse_.begin(factorised_step_ == step && system_.tangent_holds());
  progress.started_with_kept = !factorise;
  made_kept_updates_ = false;
  for (; progress.iteration < settings_.max_iterations; ++progress.iteration) {
    if (const Reason failure = evaluate(factorise); failure != Reason::None) return failure;
    if (progress.since_revision > 0 && system_.revise()) {
      progress.since_revision = 0;
      factorise = true;
      if (const Reason failure = evaluate(true); failure != Reason::None) return failure;
    }
    ++result.iterations;
    result.factorisations += factorise;
    progress.kept_before = progress.with_kept;
    progress.with_kept = !factorise;
    made_kept_updates_ |= progress.with_kept;
    if (const Reason failure = find_update(updates, progress); failure != Reason::None) return failure;
    if (factorise) factorised_step_ = step;
    if (diverges(progress)) return Reason::NoConvergence;
    factorise = makes_new || renews_factors(progress);
    if (is_led_astray(progress)) return Reason::NoConvergence;
    if (is_useless(progress)) {
      norms_.pop_back();
      progress.with_kept = false;
      factorise = makes_new = true;
      continue;
    }
    damp(progress);
    ++progress.since_revision;
    const bool ends = has_converged(progress, factors);
    if (factorise && !progress.with_kept && !ends) system_.carry_strains(progress.fraction);
    system_.update(update_);
    if (!ends) continue;
    if (const Reason failure = evaluate(false); failure != Reason::None) return failure;
    if (system_.revise()) {
      progress.since_revision = 0;
      factorise = true;
    } else if (is_as_expected(progress)) {
      return Reason::None;
    }
  }
  return Reason::NoConvergence;
}

bool StepSystem::evaluate(bool with_tangent) {
  if (configuration_.is_off_line()) return false;
  Balance balance{rows_, with_tangent ? &tangent() : nullptr};
  rows_.set_zero();
  if (with_tangent) tangent().set_zero(), evaluated_ = &tangent();
  if (with_tangent && family().carries_strains()) {
    carried_rows_.set_zero();
    balance.carried = &carried_rows_;
  }

  add_forces(balance);
  if (scheme().is_static)
    drag_.evaluate(balance);
  else
    family().add_inertia(balance);
  loops_.evaluate(balance);
  actuators_.evaluate(balance);
  joints_.evaluate(balance);

  if (with_tangent) tangent().finish();
  friction_.hold(balance);
  rows_.gather(residual_);
  dissipated_ = balance.dissipated;
  return residual_.allFinite() && std::isfinite(dissipated_);
}

void StepSystem::add_forces(Balance& balance) {
  family().add_forces(balance);
  family().add_loads(forces_, balance);
  force_elements_.evaluate(balance);
}

void StepSystem::update(const Eigen::VectorXd& increment) {
  reversals_.before_update();
  contacts_.before_update();
  configuration_.update(increment);
  loops_.update(increment);
  friction_.place_held();
  reversals_.after_update();
  contacts_.after_update();
  configuration_.set_slaves();
}

// ---------------------------------------------------------------- accept

void StepSystem::accept(State& state) {
  if (scheme().is_static) return accept_rest(state);
  efforts_.find_drives(rows_, held_efforts_, state.drives);
  reactions_.accept(rows_, state);
  friction_.accept(state);
  force_elements_.accept(state);
  double work = 0;
  forces_.add_work(work);
  force_elements_.add_work(work);
  efforts_.add_work(work);
  if (prestrains_.do_work()) work += family().work_of_prestrains();
  state.work += work;
  state.dissipated += dissipated_;
  configuration_.remember_increments(state.history);
  space_.tidy(state.history);
  scales_.choose_order(state.history);
  loops_.remember(state.history);
  family().accept(state);
  joints_.accept(state);
  efforts_.accept(state);
  actuators_.accept(state);
  if (configuration_.led_to()) state.drives.begin_anew(), state.transmitted.begin_anew();
  state.time = configuration_.end_time();
}

}  // namespace flexarm
