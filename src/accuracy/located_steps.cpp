#include "accuracy/located_steps.h"

#include <algorithm>
#include <cmath>

#include "joints/set_points.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Tolerance with which events are found, relative to the longest step. A step that ends this far from where a force
/// jumps has this part of the velocity's error that a whole step across the jump would have.
constexpr double kFound = 1e-8;
/// The same for stops by friction, which make no error of the velocity, and for kinks, whose error is quadratic.
constexpr double kSlide = 1e-3;
/// Relative to the last correction. A repeated step is longer by this than to where the event is expected, so that it
/// ends after the event: it then shows the event's place better than a step that ends before.
constexpr double kBeyond = 2e-3;
/// Most repetitions of a step that should end at an event.
constexpr int kMostLocations = 10;
/// Most steps that end at events in a cell. Further events, as of a box that rattles on its corners, are stepped over.
constexpr int kMostEventsInCell = 64;
/// Relative to a step. If no event was found and the step has become shorter than this, a force jumps back and forth:
/// the whole step is made.
constexpr double kShortest = 0.05;
/// Hits are resolved more finely by this factor times the number of steps in a cell.
constexpr double kRefinement = 2;
/// In a hit, steps become longer by two after this many good ones, times the number of steps in a cell.
constexpr int kGoodSteps = 6;
/// Most halvings of steps in a hit, as in a step.
constexpr int kMostLevels = 40;
/// Relative to a step: sums of steps may miss times by this.
constexpr double kMissedTime = 1e-9;
/// Relative to the longest cell: length of the steps before and after a jump of a set point that strikes.
constexpr double kStrike = 1e-6;
/// How far from a time set points are compared, relative to such a step; and their difference, relative to themselves,
/// that is a jump.
constexpr double kInstant = 1e-6, kJump = 1e-6;
/// Range of the tolerance of Newton's method.
constexpr double kLeastTolerance = 1e-13, kMostTolerance = 1e-3;

void add_corners(const TimeFunction& function, double begin, double end, std::vector<double>& times) {
  const std::vector<double> corners = function.corners(begin, end);
  times.insert(times.end(), corners.begin(), corners.end());
}

/// Adds the times after `begin` of samples, of delayed samples that take effect, and of ends of commands to set points.
void add_times_of_servo(const Actuator& actuator, const ActuatorState& state, double begin, double end,
                        std::vector<double>& times) {
  if (!actuator.servo) return;
  if (!std::isnan(state.servo.set_point)) times.push_back(state.servo.set_time);
  const double period = actuator.servo->sample_time;
  if (period == 0) return;
  for (double n = std::ceil(begin / period); n * period < end; ++n) times.push_back(n * period);
  const double lag = std::fmod(actuator.servo->delay, period);
  if (lag == 0) return;
  for (double n = std::ceil((begin - lag) / period); n * period + lag < end; ++n) times.push_back(n * period + lag);
}

/// Whether the set point of a servo jumps at a time, so that the derivative of its error strikes.
bool strikes(const Model& model, const State& state, std::size_t actuator, double time, double length) {
  const TimeFunction* set_point = striking_set_point(model, model.actuators[actuator], state.actuators[actuator].servo);
  if (!set_point) return false;
  const double before = (*set_point)(time - kInstant * length), after = (*set_point)(time + kInstant * length);
  return std::abs(after - before) > kJump * std::max(std::abs(before), std::abs(after));
}

/// Adds ends of short cells before and after such times. A step spreads the strike of a servo over its length, and an
/// implicit scheme would otherwise have an error of first order there. An explicit scheme changes velocities at once.
std::vector<double> with_strikes_apart(const Simulation& simulation, const std::vector<double>& cells) {
  if (scheme_of(simulation).tableau) return cells;
  const Model& model = model_of(simulation);
  double longest = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) longest = std::max(longest, cells[i] - cells[i - 1]);
  const double length = kStrike * longest;
  std::vector<double> out;
  out.reserve(3 * cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    bool is_struck = false;
    for (std::size_t k = 0; k < model.actuators.size(); ++k)
      is_struck = is_struck || strikes(model, state_of(simulation), k, cells[i], length);
    if (is_struck && i > 0 && cells[i] - cells[i - 1] > 3 * length) out.push_back(cells[i] - length);
    out.push_back(cells[i]);
    if (is_struck && i + 1 < cells.size() && cells[i + 1] - cells[i] > 3 * length) out.push_back(cells[i] + length);
  }
  return out;
}

/// Largest effort of an actuator's motor.
double effort_limit(const Model& model, const Actuator& actuator) {
  return std::min(actuator.drive.effort_limit, servo_limit(model, actuator));
}

/// Whether forces may jump at times that cannot be foreseen, and steps can find these.
bool may_have_hits(const Model& model) {
  return has_stops(model) || std::any_of(model.force_elements.begin(), model.force_elements.end(),
                                         [](const auto& element) { return element->hits(); });
}

bool may_have_events(const Simulation& simulation) {
  if (scheme_of(simulation).tableau) return false;
  const Model& model = model_of(simulation);
  const bool by_joints = std::any_of(model.coordinates.begin(), model.coordinates.end(),
                                     [](const Coordinate& c) { return c.friction > 0 || c.friction_coefficient > 0; });
  const bool by_drives = std::any_of(model.actuators.begin(), model.actuators.end(), [&](const Actuator& a) {
    return a.drive.friction > 0 || a.drive.loss > 0 || (a.drive.gear && a.drive.gear->backlash > 0) ||
           effort_limit(model, a) < Drive::kInfinity;
  });
  const bool by_slides =
      std::any_of(model.joints.begin(), model.joints.end(), [](const JointMap& joint) { return joint.leaving >= 0; });
  return by_joints || by_drives || by_slides || may_have_hits(model);
}

}  // namespace

std::vector<double> known_corners(const Simulation& simulation, double begin, double end) {
  const Model& model = model_of(simulation);
  const State& state = state_of(simulation);
  std::vector<double> times;
  for (const TimeFunction& history : model.histories) add_corners(history, begin, end, times);
  for (std::size_t i = 0; i < model.actuators.size(); ++i)
    add_times_of_servo(model.actuators[i], state.actuators[i], begin, end, times);
  std::sort(times.begin(), times.end());
  times.erase(std::remove_if(times.begin(), times.end(), [&](double time) { return time <= begin || time >= end; }),
              times.end());
  return times;
}

LocatedSteps::LocatedSteps(Simulation& simulation, const std::vector<double>& cells)
    : simulation_(simulation),
      cells_(with_strikes_apart(simulation, cells)),
      step_of_scene_(step_of_constants(simulation)),
      has_events_(may_have_events(simulation)),
      has_hits_(has_events_ && may_have_hits(model_of(simulation))) {
  for_each_element(model_of(simulation).beams, [&](const auto&) { bends_ = true; });
  for (std::size_t i = 1; i < cells_.size(); ++i) longest_ = std::max(longest_, cells_[i] - cells_[i - 1]);
}

double LocatedSteps::steps_of(double length, double steps) const {
  return std::max(1.0, std::ceil(steps * (std::sqrt(length / longest_) - kMissedTime)));
}

double LocatedSteps::planned(double steps) const {
  double sum = 0;
  for (std::size_t i = 1; i < cells_.size(); ++i) sum += steps_of(cells_[i] - cells_[i - 1], steps);
  return sum;
}

void LocatedSteps::go_back(const Snapshot& start) {
  set_step_of_constants(simulation_, step_of_scene_);
  simulation_.restore(start);
}

void LocatedSteps::set(int steps, double tolerance) {
  steps_ = steps;
  tolerance_ = tolerance;
  iterations = recoveries = 0;
  turn = 0;
  had_contacts = false;
  next_ = 1;
  level_ = kNoHit;
  is_new_hit_ = is_at_event_ = false;
  set_step_of_constants(simulation_, std::min(step_of_scene_, step()));
}

StepResult LocatedSteps::step(double length, double tolerance, RunWatcher& watcher) {
  // Steps of cells of equal length differ by round-off. If the length stays the same, the simulation keeps what it has
  // learned.
  const bool stays = std::abs(length - simulation_.step_size()) <= kMissedTime * length;
  EventSearch events;
  if (has_events_) events = {tolerance, kSlide * step_now(), std::max(1.0, kRefinement * steps_), level_ > 0};
  flexarm::set_step(simulation_, stays ? simulation_.step_size() : length, events);
  // A remainder of a solve makes an error of the velocity. The shorter the step, the larger is this error.
  simulation_.set_tolerance(
      std::clamp(tolerance_ * std::sqrt(std::min(1.0, length / step())), kLeastTolerance, kMostTolerance));
  watcher.before_step(simulation_);
  StepResult result = simulation_.step();
  iterations += result.iterations;
  recoveries += result.other_guesses + (has_events_ ? 0 : result.halvings);
  turn = std::max(turn, 2 * std::atan(0.5 * result.largest_rotation));
  return result;
}

/// Makes a step of this length, or a shorter one that ends at the first event in it.
StepResult LocatedSteps::located_step(double length, RunWatcher& watcher) {
  double tolerance = events_ < kMostEventsInCell ? kFound * step_now() : length;
  if (is_at_event_) begin_anew(simulation_, length);
  if (has_events_) simulation_.snapshot(before_);
  double whole = length;
  StepResult result = this->step(length, tolerance, watcher);
  // The first step of a hit shows how long its steps may be.
  if (is_new_hit_ && result.deepest_halving > 0 && is_in_hit()) {
    simulation_.restore(before_);
    const double longest = std::ldexp(length, -result.deepest_halving);
    if (is_at_event_) begin_anew(simulation_, longest);
    level_ = std::clamp(static_cast<int>(std::log2(step() / longest)), 0, kMostLevels);
    whole = length = std::min(length, step_now());
    tolerance = events_ < kMostEventsInCell ? kFound * step_now() : length;
    result = this->step(length, tolerance, watcher);
  }
  is_new_hit_ = is_new_hit_ && length < 0.5 * step_now();
  for (int n = 1; result.reason == StepResult::Reason::EventWithin && !result.converged; ++n) {
    const double correction = length - event_of(simulation_);
    length -= (1 - kBeyond) * correction;
    simulation_.restore(before_);
    // Events that are not found soon are stepped over.
    const bool is_found = n < kMostLocations;
    if (!is_found && length < kShortest * whole) length = whole;
    result = this->step(length, is_found ? tolerance : length, watcher);
  }
  is_at_event_ = length < whole;
  events_ += is_at_event_ ? 1 : 0;
  return result;
}

double LocatedSteps::step_now() const {
  return std::ldexp(step(), -std::max(level_, 0));
}

double LocatedSteps::next_length(double rest, double longest) const {
  if (level_ == kNoHit) return rest / std::ceil(rest / longest - kMissedTime);
  // The last two steps share what is left of the cell, so that none is much shorter.
  const double length = std::min(step_now(), longest);
  return rest >= 2 * length ? length : rest > (1 + kMissedTime) * length ? 0.5 * rest : rest;
}

bool LocatedSteps::is_in_contact() const {
  const double* memory = state_of(simulation_).force_memory.data();
  for (const auto& element : model_of(simulation_).force_elements) {
    if (element->hits() && element->remembers(memory)) return true;
    memory += element->memory_size();
  }
  return false;
}

bool LocatedSteps::is_in_hit() const {
  if (is_in_contact()) return true;
  const std::vector<Coordinate>& coordinates = model_of(simulation_).coordinates;
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const auto& limit = coordinates[c].limit;
    if (limit && (simulation_.position(c) < limit->lower || simulation_.position(c) > limit->upper)) return true;
  }
  return false;
}

/// Chooses the steps of a hit. They are parts of the longest step by powers of two, which depend on the hit alone: the
/// rule for hits is finer by the number of steps in a cell. So the steps of all tries are in the ratio of these
/// numbers.
void LocatedSteps::follow_hit() {
  const int halvings = state_of(simulation_).halving_level;
  had_contacts = had_contacts || is_in_contact() || (bends_ && is_in_hit());
  if (is_at_event_) {
    good_steps_ = 0;
    is_new_hit_ = is_new_hit_ || level_ == kNoHit;  // perhaps
    level_ = std::max(level_, 0);
    return;
  }
  if (level_ == kNoHit) return;
  if (!is_in_hit()) {
    level_ = kNoHit;
    is_new_hit_ = false;
    return;
  }
  if (halvings > 0) {
    level_ = std::min(level_ + halvings, kMostLevels);
    good_steps_ = 0;
  } else if (level_ > 0 && ++good_steps_ >= kGoodSteps * steps_) {
    --level_;
    good_steps_ = 0;
  }
}

bool LocatedSteps::advance_through_cell(double end, RunWatcher& watcher, AccurateRun& run) {
  const double longest = (end - simulation_.time()) / steps_of(cells_[next_] - cells_[next_ - 1], steps_);
  events_ = 0;
  double rest;
  while ((rest = end - simulation_.time()) > kMissedTime * longest) {
    run.last = located_step(next_length(rest, longest), watcher);
    ++run.steps;
    if (has_hits_) follow_hit();
    run.end = AccurateRun::End::Interrupted;
    if (!watcher.after_step(simulation_, run.last)) return false;
    run.end = AccurateRun::End::Failed;
    if (!run.last.converged) return false;
  }
  correct_time(simulation_, end);
  return true;
}

bool LocatedSteps::advance_to(double time, RunWatcher& watcher, AccurateRun& run) {
  for (; next_ < cells_.size() && cells_[next_] <= time; ++next_)
    if (!advance_through_cell(cells_[next_], watcher, run)) return false;
  return true;
}

}  // namespace flexarm
