#include "integrators/event_march.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "joints/joint_stop.h"
#include "math/step_end.h"

namespace flexarm {
namespace {

/// If the remaining part of a sub-step is shorter than this fraction of it, it is left out: it changes a state by less
/// than the round-off of the velocities.
constexpr double kNothing = 1e-9;
/// With more events than this in one sub-step, their order cannot be determined.
constexpr int kMostEvents = 12;
/// Limit for the evaluations that locate an event.
constexpr int kMostTries = 60;
/// A coordinate rests on its stop if the damper contributes less than this share to the stop's push.
constexpr double kQuiet = 1e-3;

StepSettings settings_of_march() {
  StepSettings settings;
  settings.tolerance = 1e-9;
  settings.max_iterations = 40;
  settings.reuse_factorisation = false;
  return settings;
}

}  // namespace

EventMarch::EventMarch(const Model& model, const Scheme& scheme)
    : model_(model),
      at_end_(!scheme.is_incremental()),
      settings_(settings_of_march()),
      system_(model, scheme),
      newton_(system_, settings_),
      rate_(model) {
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    if (!model.coordinates[i].limit) continue;
    const double damping = model.coordinates[i].limit->damping;
    for (int side = 0; side < 2; ++side) corners_.push_back({false, static_cast<int>(i), side, damping});
  }
  const std::vector<FrictionCarrier>& carriers = system_.friction().carriers();
  for (std::size_t c = 0; c < carriers.size(); ++c)
    if (model.coordinates[carriers[c].coordinate].motion < 0)
      corners_.push_back({true, carriers[c].coordinate, static_cast<int>(c), 0});
  modes_.stops.assign(model.coordinates.size(), {StopContact::Off, StopContact::Off});
  modes_.friction.assign(carriers.size(), StickSlip::HeldLow);
  holds_.resize(carriers.size());
  stages_.assign(corners_.size(), 0);
  system_.hold_modes(&modes_);
}

// ---------------------------------------------------------------- stages

void EventMarch::set_stage(std::size_t index, int stage) {
  const Corner& corner = corners_[index];
  stages_[index] = stage;
  if (corner.is_friction)
    modes_.friction[corner.place] = stage > 0   ? StickSlip::SlipForth
                                    : stage < 0 ? StickSlip::SlipBack
                                                : StickSlip::HeldLow;
  else
    modes_.stops[corner.coordinate][corner.place] = stage == kIn ? StopContact::On : StopContact::Off;
}

void EventMarch::set_stages(const std::vector<int>& stages) {
  assert(stages.size() == corners_.size());
  for (std::size_t i = 0; i < stages.size(); ++i) set_stage(i, stages[i]);
}

void EventMarch::restart(const State& state) {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& corner = corners_[i];
    if (corner.is_friction) {
      const double now = state.rests[corner.coordinate] > 0 ? 0 : rate_(model_, state, corner.coordinate);
      set_stage(i, (now > 0) - (now < 0));
    } else {
      set_stage(i, static_cast<int>(stop_stage(reach(corner, model_, state))));
    }
  }
}

StopReach EventMarch::reach(const Corner& corner, const Model& model, const State& state) {
  const Coordinate& coordinate = model.coordinates[corner.coordinate];
  return stop_reach(*coordinate.limit, corner.place == 1,
                    state.released[coordinate.joint].displacement[coordinate.component % 3],
                    rate_(model, state, corner.coordinate));
}

double EventMarch::guard(std::size_t index, int stage, const Model& model, const State& state) {
  assert(index < corners_.size());
  const Corner& corner = corners_[index];
  if (corner.is_friction) return stage * rate_(model, state, corner.coordinate);
  const StopReach now = reach(corner, model, state);
  if (stage == kReleased && now.depth <= 0) return 1;  // march() notices that
  return stop_guard(static_cast<StopStage>(stage), now);
}

double EventMarch::guard_now(std::size_t index, const State& state) {
  const Corner& corner = corners_[index];
  if (!corner.is_friction || stages_[index] != 0) return guard(index, stages_[index], model_, state);
  const Hold& hold = holds_[corner.place];
  // In a conserving scheme the reaction is the mean over a piece, so it is extrapolated by half a piece to the end.
  const double end = at_end_ || hold.pieces < 2 ? hold.reaction : 1.5 * hold.reaction - 0.5 * hold.before;
  return hold.capacity - std::abs(end);
}

std::size_t EventMarch::violated(const State& state) {
  for (std::size_t i = 0; i < corners_.size(); ++i)
    if (guard_now(i, state) < 0) return i;
  return kNone;
}

bool EventMarch::is_wanted(const State& state, const StepSystem& solved) {
  const StepConfiguration& configuration = solved.configuration();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& corner = corners_[i];
    if (corner.is_friction) {
      const StickSlip& law = solved.friction().carriers()[corner.place].law;
      const bool goes_on =
          stages_[i] == 0 ? law.is_held() && law.held_increment() == 0 : law.branch() == modes_.friction[corner.place];
      if (!goes_on) return true;
      continue;
    }
    const Coordinate& coordinate = model_.coordinates[corner.coordinate];
    const double end = configuration.released()[coordinate.joint].displacement[coordinate.component % 3];
    const double begin = state.released[coordinate.joint].displacement[coordinate.component % 3];
    const LimitStop& limit = *coordinate.limit;
    const bool is_deep = corner.place == 0 ? std::min(begin, end) < limit.lower : std::max(begin, end) > limit.upper;
    if (!is_deep && stages_[i] == kOut) continue;
    if (stages_[i] != kIn) return true;
    const double mean = (end - begin) / configuration.step();
    const auto is_quiet = [&](double position, double speed) {
      const StopReach now = stop_reach(limit, corner.place == 1, position, speed);
      return now.depth > 0 && std::abs(corner.damping * now.rate) <= kQuiet * now.push;
    };
    if (!is_quiet(begin, rate_(model_, state, corner.coordinate)) || !is_quiet(end, mean)) return true;
  }
  return false;
}

bool EventMarch::is_hit(const State& state, const std::vector<int>* stages) {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (corners_[i].is_friction || (stages && (*stages)[i] != kIn)) continue;
    const StopReach now = reach(corners_[i], model_, state);
    if (!stages && (now.depth <= 0 || now.push <= 0)) continue;
    if (std::abs(corners_[i].damping * now.rate) > kQuiet * now.push) return true;
  }
  return false;
}

// ---------------------------------------------------------------- pieces

bool EventMarch::solve(const State& state, double step) {
  StepResult result;
  for (const Guess guess : {Guess::Extrapolated, Guess::Unchanged}) {
    system_.invalidate();
    system_.begin(state, step, guess);
    if (newton_.solve(NewtonIteration::Updates::Limited, NewtonIteration::Factors::Fresh, result)) {
      note_holds();
      return true;
    }
  }
  return false;
}

void EventMarch::note_holds() {
  const std::vector<FrictionCarrier>& carriers = system_.friction().carriers();
  for (std::size_t c = 0; c < carriers.size(); ++c) {
    Hold& hold = holds_[c];
    hold = {carriers[c].reaction, carriers[c].capacity, hold.reaction, hold.pieces + 1};
  }
}

bool EventMarch::advance(State& state, double step) {
  if (!solve(state, step)) return false;
  system_.accept(state);
  return true;
}

bool EventMarch::run(State& state, double length, int pieces, std::size_t& left, int& piece) {
  left = kNone;
  for (Hold& hold : holds_) hold.pieces = 0;
  for (piece = 0; piece < pieces; ++piece) {
    if (!advance(state, length / pieces)) return false;
    left = violated(state);
    if (left != kNone) return true;
  }
  return true;
}

bool EventMarch::guard_after(const State& start, double length, int pieces, std::size_t corner, double& guard) {
  other_ = start;
  for (Hold& hold : holds_) hold.pieces = 0;
  for (int k = 0; k < pieces; ++k)
    if (!advance(other_, length / pieces)) return false;
  guard = guard_now(corner, other_);
  return true;
}

/// Locates the event by the Illinois variant of the secant method, which keeps a bracket.
bool EventMarch::locate(const State& start, double begin, double end, int pieces, std::size_t corner, double& length) {
  double at_begin, at_end;
  const bool is_stuck = corners_[corner].is_friction && stages_[corner] == 0;
  if (begin == 0 && !is_stuck) {
    at_begin = guard(corner, stages_[corner], model_, start);
  } else if (!guard_after(start, begin == 0 ? 1e-2 * end : begin, pieces, corner, at_begin)) {
    return false;
  }
  length = begin;
  if (at_begin <= 0) return true;
  if (!guard_after(start, end, pieces, corner, at_end)) return false;
  length = end;
  if (at_end >= 0) return true;
  const double whole = end;
  int kept = 0;  // the end of the bracket that the last try kept: > 0 the end, < 0 the beginning
  for (int tries = 0; tries < kMostTries; ++tries) {
    const double last = length;
    length = end - at_end * (end - begin) / (at_end - at_begin);
    if (std::abs(length - last) <= kNothing * whole) return true;
    double now;
    if (!guard_after(start, length, pieces, corner, now)) return false;
    if (now == 0) return true;
    if (now < 0) {
      end = length, at_end = now;
      if (kept < 0) at_begin *= 0.5;
      kept = -1;
    } else {
      begin = length, at_begin = now;
      if (kept > 0) at_end *= 0.5;
      kept = 1;
    }
  }
  return true;
}

/// Finds the first event within `left` [s] after `start`. Sets `corner` to its corner, or kNone, and `length` to the
/// time from `start` to the event.
bool EventMarch::find_next(const State& start, double left, int pieces, std::size_t& corner, double& length) {
  trial_ = start;
  int piece = 0;
  length = left;
  if (!run(trial_, left, pieces, corner, piece)) return false;
  if (corner == kNone) return true;
  double begin = piece * left / pieces, end = (piece + 1) * left / pieces;
  for (std::size_t tries = 0; tries <= corners_.size(); ++tries) {
    if (!locate(start, begin, end, pieces, corner, length)) return false;
    if (length <= kNothing * left) return true;
    // Check whether another event comes before this one.
    double now;
    if (!guard_after(start, length, pieces, corner, now)) return false;
    std::size_t other = kNone;
    for (std::size_t i = 0; i < corners_.size() && other == kNone; ++i)
      if (i != corner && guard_now(i, other_) < 0) other = i;
    if (other == kNone) return true;
    corner = other, begin = 0, end = length;
  }
  return true;
}

bool EventMarch::march(State& state, double length, int pieces, MarchFollower& follower) {
  for (Hold& hold : holds_) hold.pieces = 0;
  for (int k = 0; k < pieces; ++k) {
    if (!solve(state, length / pieces)) return false;
    follower.follow_piece(state, system_);
    system_.accept(state);
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (!corners_[i].is_friction && stages_[i] == kReleased && reach(corners_[i], model_, state).depth <= 0)
        set_stage(i, kOut);
  }
  return true;
}

std::string EventMarch::go(State& state, double length, int pieces, MarchFollower& follower) {
  assert(length > 0 && pieces >= 1);
  const double begin = state.time;
  double left = length;
  last_jump_ = kNone;
  for (int events = 0; left > kNothing * length; ++events) {
    if (events > kMostEvents) return "a step has more events of stops and friction than can be followed";
    std::size_t corner;
    double way;
    if (!find_next(state, left, pieces, corner, way)) return "events cannot be found: a part of the step fails";
    if (way > kNothing * length) {
      if (!march(state, way, pieces, follower)) return "events cannot be found: a part of the step fails";
      left -= way;
    }
    if (corner == kNone) break;
    if (!cross(state, corner, length, length / pieces, follower))
      return "velocities before and after an event cannot be found";
  }
  state.time = step_end(begin, length);
  return "";
}

}  // namespace flexarm
