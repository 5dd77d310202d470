#include "analysis/settling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/node_ways.h"
#include "analysis/passed_contacts.h"

namespace flexarm {
namespace {

/// Length of a step at which the search aims, and the longest one that is accepted [rad, or in units of the length
/// scale]. Over such lengths the directions of forces are about constant.
constexpr double kAimedWay = 0.3, kLongestWay = 1;
/// Most steps, and most attempts at one step, before the search is given up.
constexpr int kMostSteps = 300, kMostAttempts = 30;
/// Factor by which the drag grows if a step fails, and the smallest one by which it shrinks from a step to the next.
constexpr double kMoreDrag = 4, kLessDrag = 1. / 16;
/// If steps become longer, the mechanism is leaving an unstable equilibrium, to which Newton's steps would lead back.
/// So the drag shrinks only after this many steps in a row have become shorter.
constexpr int kShorterInARow = 3;
/// A mechanism that has not come to rest and has moved farther than this moves without limit [rad, or in units of the
/// length scale].
constexpr double kFar = 30;

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
  double last_way = 0, all_ways = 0;
  State last = state;
  for (int step = 0, attempts = 0, shorter = 0; step < kMostSteps; ++step) {
    drag = std::max(drag, neutral_);
    system_.begin_equilibrium(state, load_factor, drag);
    const bool is_solved = newton_.solve(NewtonIteration::Updates::Limited, NewtonIteration::Factors::Fresh, result);
    const double way = is_solved ? system_.drag().largest_way() : std::numeric_limits<double>::infinity();
    State next = state;
    if (is_solved) system_.accept(next);
    if (!(way <= kLongestWay) || pass_through(model_, state, next)) {
      if (is_solved) result.reason = StepResult::Reason::NoConvergence;
      if (++attempts == kMostAttempts) return false;
      drag *= kMoreDrag;
      continue;
    }
    attempts = 0;
    all_ways += way;
    last = std::move(state);
    state = std::move(next);
    if (way <= tolerance_) return true;
    shorter = way < last_way ? shorter + 1 : 0;
    if (way > kAimedWay || shorter >= kShorterInARow) drag *= std::max(way / kAimedWay, kLessDrag);
    last_way = way;
  }
  result.reason = StepResult::Reason::NoConvergence;
  if (all_ways < kFar) return false;
  result.reason = StepResult::Reason::NeverRests;
  result.failure.place = {};
  result.failure.place.link = NodeWays(model_, ways_between(last, state)).link_index();
  return false;
}

}  // namespace flexarm
