// EventMarch: how it passes an event. It chooses the next stage, and finds the jump of the rates.
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "integrators/event_march.h"
#include "model/state_numbers.h"

namespace flexarm {
namespace {

/// Rates on the two sides of an event are compared over this fraction of a piece. Their discretisation error is of
/// third order in this length, their round-off error is proportional to its inverse square.
constexpr double kGlance = 0.25;
/// Two events that are closer than this fraction of a sub-step may occur in the other order in a neighbour.
constexpr double kSameInstant = 1e-2;

}  // namespace

int EventMarch::next_stage(std::size_t index, State& state, double step) {
  const Corner& corner = corners_[index];
  if (!corner.is_friction) return stages_[index] == kIn ? kReleased : kIn;
  const auto slip = [&] { return holds_[corner.place].reaction > 0 ? 1 : -1; };
  if (stages_[index] == 0) {
    state.rests[corner.coordinate] = 0;
    return slip();
  }
  // It sticks if friction can hold it at rest.
  set_stage(index, 0);
  state.rests[corner.coordinate] = 1;
  other_ = state;
  const Hold& hold = holds_[corner.place];
  if (!advance(other_, step) || std::abs(hold.reaction) <= hold.capacity) return 0;
  return slip();
}

bool EventMarch::find_jump(const State& state, const EventModes& before, double step, Crossing& crossing) {
  const EventModes after = modes_;
  const auto differences = [&](double glance, std::vector<double>& out, double& slope) {
    trial_ = other_ = state;
    modes_ = before;
    const bool is_done = advance(trial_, glance);
    modes_ = after;
    if (!is_done || !advance(other_, glance)) return false;
    slope = (guard(crossing.corner, crossing.from, model_, trial_) - crossing.guard) / glance;
    out.clear();
    for_each_number(trial_, [&](const char*, double number) { out.push_back(number); });
    std::size_t i = 0;
    for_each_number(other_, [&](const char*, double number) {
      out[i] = (out[i] - number) / glance;
      ++i;
    });
    return true;
  };
  std::array<double, 3> slope{};
  if (!differences(step, first_, slope[0]) || !differences(step / 2, second_, slope[1]) ||
      !differences(step / 4, third_, slope[2]))
    return false;
  const auto limit = [](double one, double half, double quarter) {
    return (4 * (2 * quarter - half) - (2 * half - one)) / 3;
  };
  jump_.resize(first_.size());
  for (std::size_t i = 0; i < jump_.size(); ++i) {
    // Numbers that are not integrals over time, such as forces, jump themselves. Neighbours compute them anew.
    const bool is_rate = std::abs(first_[i] - second_[i]) <= 0.5 * std::abs(first_[i]);
    jump_[i] = is_rate && std::isfinite(first_[i]) ? limit(first_[i], second_[i], third_[i]) : 0.0;
  }
  crossing.slope = limit(slope[0], slope[1], slope[2]);
  if (corners_[crossing.corner].is_friction && !find_rate_slope(state, before, step, crossing)) return false;
  crossing.jump = &jump_;
  return true;
}

/// Velocities of conserving schemes have an error that alternates from step to step. Its sign is the same in steps of
/// equal parity, so the slope is computed from such steps.
bool EventMarch::find_rate_slope(const State& state, const EventModes& before, double step, Crossing& crossing) {
  const EventModes after = modes_;
  std::array<double, 2> slope{};
  modes_ = before;
  bool is_done = true;
  for (int half = 0; half < 2 && is_done; ++half) {
    const double part = half == 0 ? step : step / 2;
    trial_ = state;
    is_done = advance(trial_, part);
    const double first = guard(crossing.corner, crossing.from, model_, trial_);
    is_done = is_done && advance(trial_, part) && advance(trial_, part);
    slope[half] = (guard(crossing.corner, crossing.from, model_, trial_) - first) / (2 * part);
  }
  modes_ = after;
  crossing.slope = 2 * slope[1] - slope[0];
  return is_done;
}

bool EventMarch::cross(State& state, std::size_t index, double step, double piece, MarchFollower& follower) {
  Crossing crossing;
  crossing.time = state.time;
  crossing.corner = index;
  crossing.from = stages_[index];
  crossing.jumps = corners_[index].is_friction ? crossing.from != 0 : crossing.from == kOut;
  if (crossing.jumps) crossing.guard = guard(index, crossing.from, model_, state);
  before_ = modes_;
  crossing.to = next_stage(index, state, kGlance * piece);
  set_stage(index, crossing.to);
  if (crossing.jumps) {
    if (!find_jump(state, before_, kGlance * piece, crossing)) return false;
    // The derivative is reliable only if the guard's rate in the next step has the same sign and a similar size.
    trial_ = state;
    std::swap(modes_, before_);
    const bool is_done = advance(trial_, step);
    std::swap(modes_, before_);
    const double mean = is_done ? (guard(index, crossing.from, model_, trial_) - crossing.guard) / step : 0;
    if (crossing.slope >= 0 || std::abs(mean - crossing.slope) > std::abs(crossing.slope))
      crossing.doubt = "the event is grazing: its rate is smaller than the change of that rate in a step";
    else if (last_jump_ != kNone && last_jump_ != index && state.time - last_jump_time_ <= kSameInstant * step)
      crossing.doubt = fmt::format("it happens at the same time as the event of '{}', possibly before it",
                                   model_.coordinates[corners_[last_jump_].coordinate].name);
    if (crossing.doubt.empty() && at_end_)
      crossing.doubt = "schemes of the Newmark family keep accelerations from before the event";
    last_jump_ = index;
    last_jump_time_ = state.time;
  }
  follower.cross(crossing);
  return true;
}

}  // namespace flexarm
