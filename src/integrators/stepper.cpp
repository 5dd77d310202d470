#include "integrators/stepper.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "integrators/dissipative_substitute.h"
#include "integrators/explicit_step.h"
#include "integrators/failure_place.h"
#include "integrators/study_library.h"
#include "math/flush_subnormals.h"
#include "math/step_end.h"
#include "model/line_release.h"
#include "model/room_for_wrenches.h"

namespace flexarm {
namespace {

/// A node must not turn by more than pi/2 in a step: |2 tan(angle/2)| = 2.
constexpr double kLargestStepRotation = 2.0;
/// Suzuki's composition of order four: lengths of the sub-steps relative to the step; the middle one is backwards.
const double kOuterPart = 1 / (4 - std::cbrt(4.0));
const double kComposition[kCompositionSteps] = {kOuterPart, kOuterPart, 1 - 4 * kOuterPart, kOuterPart, kOuterPart};
/// A step with this many halvings, each undone by a doubling, makes no progress and is aborted.
constexpr int kMostHalvings = 500;
/// The sub-step is doubled after this number of converged sub-steps. With a search for events, sub-steps are short for
/// a reason, and doubling them early would fail too often.
constexpr int kGoodStepsToDouble = 2, kGoodStepsToDoubleAtEvents = 6;
/// A step that ends when a slider leaves its line ends before the slider is this far beyond the end, relative to the
/// length of the last element.
constexpr double kLateRelease = 1e-3;
/// Number of halvings of a step in which forces have a kink, whose error is proportional to the square of the step.
constexpr int kKinkHalvings = 3;
/// After a step, another one that is shorter than this part of it needs new accelerations: velocities across joints are
/// wrong by the square of the longer step, and Newmark's rule divides that by the shorter one.
constexpr double kMuchShorter = 0.75;
/// The least tolerance of Newton's method where motions have kinks: round-off.
constexpr double kLeastTolerance = 1e-13;

}  // namespace

Stepper::Stepper(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : model_(model),
      scheme_(scheme),
      settings_(settings),
      system_(model, scheme, BackendChoice::Fastest, Space::PlaneWhereFound),
      newton_(system_, settings_),
      kinks_(model, scheme),
      may_release_(
          std::any_of(model.joints.begin(), model.joints.end(), [](const auto& j) { return j.leaving >= 0; })) {
  for (std::vector<double>& increment : before_.history.increments)
    increment.reserve(system_.degrees_of_freedom().unknowns);
  before_.wrenches.reserve(kRoomForWrenches);
  if (settings.on_failure == OnFailure::Dissipate)
    substitute_ = std::make_unique<DissipativeSubstitute>(model, scheme, settings);
  if (scheme.tableau) explicit_ = std::make_unique<ExplicitStep>(model, scheme);
}

Stepper::~Stepper() = default;

void Stepper::invalidate() {
  system_.invalidate();
  newton_.forget_factors();
}

void Stepper::set_step(double step, const EventSearch& events) {
  settings_.step = step;
  settings_.events = events;
  newton_.forget_factors();
  if (substitute_) substitute_->set_step(step);
}

void Stepper::set_tolerance(double tolerance) {
  settings_.tolerance = tolerance;
  if (substitute_) substitute_->set_tolerance(tolerance);
}

void Stepper::observe(StepObserver* observer) {
  observer_ = observer;
  newton_.observe(observer);
}

bool Stepper::explicit_step(State& state, double step, StepResult& result) {
  ++result.iterations;
  result.reason = explicit_->advance(state, step, settings_.reuse_factorisation);
  if (result.reason == StepResult::Reason::None) return true;
  result.failure.time = state.time;
  result.failure.step = step;
  return false;
}

bool Stepper::sub_step(State& state, double step, StepResult& result) {
  if (explicit_) return explicit_step(state, step, result);
  if (!scheme_.is_composition) return simple_step(state, step, result);
  before_ = state;
  if (follower_) follower_->keep();
  for (const double part : kComposition) {
    if (simple_step(state, part * step, result)) continue;
    state = before_;
    if (follower_) follower_->take_back();
    invalidate();
    return false;
  }
  state.time = step_end(before_.time, step);
  return true;
}

StepResult::Reason Stepper::flaw_of_solution(const State& state, double step, StepResult& result) {
  const StepConfiguration::LargestIncrement largest = system_.configuration().largest_increment();
  if (largest.size > kLargestStepRotation || system_.configuration().aliased_coordinate() >= 0)
    return StepResult::Reason::RotationTooLarge;
  if (largest.size > result.largest_rotation)
    result.largest_rotation = largest.size, result.turning_node = largest.node;
  if (system_.largest_opening().size > kOpenLoop) return StepResult::Reason::OpenLoop;
  const double refinement = settings_.events.refinement;
  const bool may_halve =
      state.halving_level < finest_halving(settings_) && result.halvings < refinement * kMostHalvings;
  if (may_halve && system_.hits_too_fast(refinement)) return StepResult::Reason::HitTooFast;
  const bool may_find_release = ends_at_release_ && state.halving_level < settings_.max_halvings;
  if (may_find_release && system_.configuration().largest_way_beyond() > kLateRelease)
    return StepResult::Reason::HitTooFast;
  return settings_.events.is_on() ? flaw_by_events(state, step, result) : StepResult::Reason::None;
}

StepResult::Reason Stepper::flaw_by_events(const State& state, double step, const StepResult& result) {
  const EventSearch& events = settings_.events;
  const int halvings_left = settings_.max_halvings - state.halving_level;
  const bool may_halve = halvings_left > 0 && result.halvings < events.refinement * kMostHalvings / 2;
  if (may_halve && system_.turn_too_fast(events.refinement)) return StepResult::Reason::HitTooFast;
  const double done = state.time - begin_;
  FirstEvent first{std::max((events.tolerance - done) / step, 0.0), events.slide / std::abs(step)};
  first.early = 2 * events.tolerance / std::abs(step);
  system_.note_events(first);
  const double event = done + first.fraction * step;
  if (std::isfinite(event) && event < settings_.step - events.tolerance) {
    event_ = event;
    return StepResult::Reason::EventWithin;
  }
  const bool halves_at_kinks = may_halve && !events.is_in_hit && state.halving_level < kKinkHalvings;
  if (halves_at_kinks && system_.has_kink()) return StepResult::Reason::HitTooFast;
  return StepResult::Reason::None;
}

StepResult Stepper::advance(State& state) {
  return advance(state, Deadline(settings_.recovery_wall_time));
}

StepResult Stepper::advance_until(State& state, const std::function<bool(const State&)>& is_end) {
  ends_at_release_ = may_release_ && !settings_.events.is_on();
  if (is_end && !settings_.events.is_on()) is_end_ = &is_end;
  StepResult result = advance(state);
  ends_at_release_ = false;
  is_end_ = nullptr;
  return result;
}

StepResult Stepper::advance(State& state, const Deadline& deadline) {
  using Reason = StepResult::Reason;
  const FlushSubnormals flush;
  if (!substitute_) return advance_by_scheme(state, deadline);
  substitute_->keep(state);
  StepResult result = advance_by_scheme(state, deadline);
  // A step that ran out of time cannot be repeated by another scheme, since no time is left.
  const bool may_be_done_again =
      !result.converged && result.reason != Reason::EventWithin && result.reason != Reason::OutOfTime;
  if (may_be_done_again && substitute_->advance(state, deadline, result)) invalidate();
  return result;
}

StepResult Stepper::advance_by_scheme(State& state, const Deadline& deadline) {
  StepResult result;
  begin_ = state.time;
  rest_ = 0;
  state.halving_level = std::clamp(state.halving_level, 0, finest_halving(settings_));
  state.drives.begin();
  state.transmitted.begin();
  if (follower_) follower_->begin_step();
  const double struck = follow_kinks(state, result);
  if (!do_sub_steps(state, settings_.step - struck, deadline, result)) return result;
  const double done = settings_.step - rest_;
  state.time = rest_ == 0 ? step_end(begin_, settings_.step) : begin_ + done;
  if (explicit_) {  // they are known at the end
    state.drives.restart(state.efforts);
    state.transmitted.restart(state.last_transmitted);
  } else {
    state.drives.end(done);
    state.transmitted.end(done);
  }
  if (follower_) follower_->end_step(done);
  if (rest_ == 0) ++state.steps;
  result.converged = true;
  return result;
}

double Stepper::follow_kinks(State& state, StepResult& result) {
  if (!kinks_.found(state, settings_.step)) return 0;
  const double length = MotionKinks::kShort * settings_.step;
  // In so short a time nothing happens, and what Newton's method leaves makes a large error of the velocity.
  const StepSettings settings = settings_;
  settings_.events = {};
  settings_.tolerance = std::max(kLeastTolerance, settings.tolerance * MotionKinks::kShort);
  double done = 0;
  system_.lead(&kinks_.places());
  if (simple_step(state, length, result)) {
    done += length;
    kinks_.let_go();
    if (simple_step(state, length, result)) done += length;
  }
  system_.lead(nullptr);
  settings_ = settings;
  newton_.forget_factors();
  state.history.clear();  // the motion does not go on as before
  return done;
}

bool Stepper::do_sub_steps(State& state, double duration, const Deadline& deadline, StepResult& result) {
  const int good_steps = settings_.events.is_on() ? kGoodStepsToDoubleAtEvents : kGoodStepsToDouble;
  const int finest = finest_halving(settings_);
  // What Newton's method leaves of an acceleration grows with the square of the steps' number, and is kept.
  const bool keeps = keeps_accelerations() && settings_.events.is_on();
  const double tolerance = settings_.tolerance;
  std::int64_t done = 0;  // in units of step / 2^finest
  const std::int64_t whole = parts_of_step(finest);
  const auto give_up = [&](bool is_late) {
    result = this->give_up(is_late, result);
    return false;
  };
  while (done < whole) {
    const int level = state.halving_level;
    if (keeps) settings_.tolerance = std::max(std::ldexp(tolerance, -level), std::min(kLeastTolerance, tolerance));
    const bool is_done = sub_step(state, std::ldexp(duration, -level), result);
    settings_.tolerance = tolerance;
    const bool is_late = level > 0 && deadline.has_passed();
    result.deepest_halving = std::max(result.deepest_halving, level);
    if (!is_done && result.reason == StepResult::Reason::EventWithin) return false;
    if (!is_done) {
      state.good_steps = 0;
      const bool may_halve = level < (!explicit_ && system_.may_hit() ? finest : settings_.max_halvings);
      if (!may_halve || result.halvings >= settings_.events.refinement * kMostHalvings) return give_up(false);
      ++state.halving_level;
      ++result.halvings;
      if (is_late) return give_up(true);  // after the halving, so that the next call starts with a shorter step
      begin_anew_if_shorter(state, std::ldexp(duration, -state.halving_level));
      continue;
    }
    done += whole >> level;
    if (ends_at_release_ && slide_beyond_end(model_, state) >= 0) break;
    if (is_end_ && (*is_end_)(state)) break;
    if (is_late && done < whole) return give_up(is_late);
    state.good_steps = std::min(state.good_steps, std::numeric_limits<int>::max() - 1) + 1;
    // A doubled sub-step must begin at a multiple of its own length.
    if (state.good_steps >= good_steps && level > 0 && done % (whole >> (level - 1)) == 0) {
      --state.halving_level;
      state.good_steps = 0;
    }
  }
  rest_ = std::ldexp(duration, -finest) * static_cast<double>(whole - done);
  return true;
}

bool Stepper::keeps_accelerations() const {
  return !scheme_.is_incremental() && !scheme_.is_static && scheme_.hht == HhtForm::None;
}

void Stepper::begin_anew_if_shorter(State& state, double step) {
  const bool is_shorter = state.history.count > 0 && step < kMuchShorter * state.history.steps[0];
  if (settings_.events.is_on() && is_shorter) begin_anew(state, step);
}

bool Stepper::begin_anew(State& state, double step) {
  if (!keeps_accelerations()) return false;
  if (!accelerations_) accelerations_ = study_library(scheme_).make_acceleration_finder(model_, settings_);
  accelerations_->renew(state, step);
  return true;
}

StepResult Stepper::give_up(bool is_late, StepResult result) {
  if (!explicit_) locate_failure(system_, result);
  if (is_late) result.reason = StepResult::Reason::OutOfTime;
  invalidate();
  return result;
}

StepResult Stepper::initialise(State& state) {
  StepResult found;
  found.converged = true;
  if (!scheme_.is_incremental())
    found = study_library(scheme_).make_acceleration_finder(model_, settings_)->find(state);
  system_.initialise(state);
  return found;
}

}  // namespace flexarm
