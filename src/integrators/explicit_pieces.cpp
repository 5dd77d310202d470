// ExplicitStep: one step of the method, and pieces of steps that end at events.
#include <algorithm>
#include <cmath>

#include "integrators/explicit_step.h"
#include "math/step_end.h"

namespace flexarm {
namespace {

/// Relative to a step: how closely the end of a piece follows the event. Forces that jump there make an error of the
/// velocity by this part of what they do in a whole step.
constexpr double kFound = 1e-10;
/// The shortest piece. In a shorter one, derivatives of functions of time would be round-off.
constexpr double kShortest = 1e-7;
/// If there are more events in a step, as of something that rattles, it goes on without looking for them.
constexpr int kMostPieces = 20;
/// Limit for the attempts that locate an event.
constexpr int kMostAttempts = 60;

}  // namespace

StepResult::Reason ExplicitStep::attempt(const State& state, double step, bool goes_on, bool keeps_contacts) {
  using Reason = StepResult::Reason;
  if (goes_on)
    begin_ = stage_;
  else
    pack(state);
  begin_[work_] = begin_[work_ + 1] = 0;
  motors_.begin(state, step);
  find_inputs(state, step, 0);
  if (dependent_.any() && !begin_dependent(state, step, begin_[work_])) return Reason::DeadPoint;
  if (!strike(state, 0, begin_)) return Reason::DeadPoint;
  const auto motion_of = [&](const std::vector<double>& numbers) {
    return [this, &numbers](std::size_t coordinate) { return link_motion(coordinate, numbers); };
  };
  bool touches = false;
  if (events_.has_stops() && !keeps_contacts) {
    unpack(begin_);
    touches = events_.begin(motion_of(begin_));
  }
  const std::size_t stages = changes_.size();
  if (goes_on && !touches && acts_as_before(state))
    changes_[0] = last_change_;
  else if (!evaluate(state, 0, begin_, changes_[0]))
    return Reason::DeadPoint;
  if (!keeps_contacts) events_.begin_kinks(margins_.numbers());
  for (std::size_t s = 1; s <= stages; ++s) {
    const std::vector<double>& weights = s < stages ? tableau_.stages[s] : tableau_.weights;
    stage_ = begin_;
    for (std::size_t r = 0; r < weights.size(); ++r) {
      if (weights[r] == 0) continue;
      const double weight = step * weights[r];
      for (std::size_t i = 0; i < stage_.size(); ++i) stage_[i] += weight * changes_[r][i];
    }
    find_inputs(state, step, s);
    if (s < stages && !evaluate(state, s, stage_, changes_[s])) return Reason::DeadPoint;
  }
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(stage_.begin(), stage_.end(), is_finite)) return Reason::NotFinite;
  normalise(stage_);
  if (!strike(state, stages, stage_)) return Reason::DeadPoint;
  gained_work_ = stage_[work_], lost_ = stage_[work_ + 1];
  if (!evaluate(state, stages, stage_, last_change_)) return Reason::DeadPoint;
  if (dependent_.any() && dependent_.largest_opening(bodies_) > kOpenLoop) return Reason::OpenLoop;
  if (events_.any()) events_.look(motion_of(stage_), margins_.numbers());
  return Reason::None;
}

void ExplicitStep::accept(State& state, double step) {
  state.work += gained_work_;
  state.dissipated += lost_;
  write(state, step);
}

StepResult::Reason ExplicitStep::end_at_event(const State& state, double whole, double& length) {
  const double tolerance = kFound * whole;
  double low = 0, high = length, weight = 1;  // nothing has happened at `low`, something has at `high`
  std::size_t event = *events_.first();
  double at_high = events_.guard(event);
  int last_moved = 0;
  for (int attempts = 0; attempts < kMostAttempts; ++attempts) {
    const double at_low = events_.low_guard(event);
    if (high - low <= tolerance || -at_high * (high - low) <= tolerance * (at_low - at_high)) break;
    // The method of Illinois. The place is a little late, so that the attempt ends behind the event.
    const double first = last_moved > 0 ? weight * at_low : at_low, last = last_moved < 0 ? weight * at_high : at_high;
    length = low + std::max(first / (first - last), 0.0) * (high - low) + 0.5 * tolerance;
    if (const auto reason = attempt(state, length, false, true); reason != StepResult::Reason::None) return reason;
    const std::optional<std::size_t> left = events_.first();
    weight = (left ? 1 : -1) == last_moved ? 0.5 * weight : 1;
    last_moved = left ? 1 : -1;
    if (left) {
      high = length;
      event = *left;
      at_high = events_.guard(event);
    } else {
      low = length;
      events_.keep_low();
    }
  }
  if (length == high) return StepResult::Reason::None;
  length = high;
  return attempt(state, length, false, true);
}

StepResult::Reason ExplicitStep::attempt_freely(const State& state, double rest, double& length) {
  events_.let_go();
  length = rest;
  return attempt(state, rest, false, true);
}

StepResult::Reason ExplicitStep::attempt_piece(const State& state, double whole, double rest, bool goes_on,
                                               double& length) {
  using Reason = StepResult::Reason;
  length = rest;
  Reason reason = attempt(state, rest, goes_on, false);
  for (int turns = 0; reason == Reason::None && events_.first(); ++turns) {
    if (turns == kMostPieces) return attempt_freely(state, rest, length);
    reason = end_at_event(state, whole, length);
    if (reason != Reason::None || length >= kShortest * whole) break;
    const std::optional<std::size_t> event = events_.first();
    if (!event) break;
    events_.turn(*event);  // it is where the piece begins
    length = rest;
    reason = attempt(state, rest, false, true);
  }
  if (reason != Reason::None || length == rest || rest - length >= kShortest * whole) return reason;
  length = rest;
  return attempt(state, rest, false, true);
}

StepResult::Reason ExplicitStep::advance(State& state, double step, bool reuses) {
  using Reason = StepResult::Reason;
  if (events_.any() && kept_.nodes.empty()) kept_ = state;  // so that it has memory when it is needed
  const double end = step_end(state.time, step);
  double rest = step;
  for (int pieces = 0; rest > 0; ++pieces) {
    double length = rest;
    const bool goes_on = reuses && is_as_left(state);
    const Reason reason =
        pieces < kMostPieces ? attempt_piece(state, step, rest, goes_on, length) : attempt_freely(state, rest, length);
    if (reason != Reason::None) {
      last_nodes_.clear();  // what was known at the end of the last step is lost
      if (pieces > 0) state = kept_;
      return reason;
    }
    if (pieces == 0 && length < rest) kept_ = state;
    accept(state, length);
    rest -= length;
  }
  state.time = last_time_ = end;
  return Reason::None;
}

}  // namespace flexarm
