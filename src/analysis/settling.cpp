#include "analysis/settling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// Way of a step that is aimed at, and the longest one that is taken [rad, or in units of the length scale]: directions
/// of forces hold so far.
constexpr double kAimedWay = 0.3, kLongestWay = 1;
/// Steps on the way, and attempts at one, until it is given up.
constexpr int kMostSteps = 300, kMostAttempts = 30;
/// By which the drag grows where a step fails, and shrinks at most from one to the next.
constexpr double kMoreDrag = 4, kLessDrag = 1. / 16;
/// Steps that become longer leave an unstable equilibrium, to which Newton's would lead back: drag shrinks once so many
/// in a row have become shorter.
constexpr int kShorterInARow = 3;

}  // namespace

bool Settling::settle(State& state, double load_factor, StepResult& result) {
  system_.begin_equilibrium(state, load_factor);
  if (!system_.evaluate(false)) {
    result.reason = StepResult::Reason::NotFinite;
    return false;
  }
  const double moment = system_.scales().largest_moment(system_.residual());
  if (moment == 0 && neutral_ == 0) return false;
  return settle(state, load_factor, moment / kAimedWay, result);
}

bool Settling::settle(State& state, double load_factor, double drag, StepResult& result) {
  double last_way = 0;
  for (int step = 0, attempts = 0, shorter = 0; step < kMostSteps; ++step) {
    drag = std::max(drag, neutral_);
    system_.begin_equilibrium(state, load_factor, drag);
    const bool is_solved = newton_.solve(NewtonIteration::Updates::Limited, NewtonIteration::Factors::Fresh, result);
    const double way = is_solved ? system_.drag().largest_way() : std::numeric_limits<double>::infinity();
    if (!(way <= kLongestWay)) {
      if (++attempts == kMostAttempts) return false;
      drag *= kMoreDrag;
      continue;
    }
    attempts = 0;
    system_.accept(state);
    if (way <= tolerance_) return true;
    shorter = way < last_way ? shorter + 1 : 0;
    if (way > kAimedWay || shorter >= kShorterInARow) drag *= std::max(way / kAimedWay, kLessDrag);
    last_way = way;
  }
  result.reason = StepResult::Reason::NeverRests;
  return false;
}

}  // namespace flexarm
