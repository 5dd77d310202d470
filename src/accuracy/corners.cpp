#include "accuracy/corners.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/inside.h"

namespace flexarm {
namespace {

/// A side that is not known yet. To change from it, or to it, is no corner.
constexpr int kUnknown = 2;
/// An effort that is below its limit by at most this part is at the limit: errors of Newton's method are smaller.
constexpr double kAtLimit = 1e-6;
/// A function jumps if it makes more than this part of its change over a step within a quarter of the step. A parabola
/// at its vertex makes 7/16, a straight line 1/4.
constexpr double kJump = 0.9;
/// Changes of a function that are smaller than this, relative to its values, are round-off.
constexpr double kRoundOffOfSums = 1e-9;

int side(double value, double lower, double upper) {
  return value < lower ? -1 : value > upper ? 1 : 0;
}

int sign(double value) {
  return side(value, 0, 0);
}

/// The largest effort that a motor can give, at its rate in the step.
double limit_of(const Actuator& actuator, const Coordinate& coordinate, double effort, double rate) {
  double limit = actuator.drive.effort_limit;
  if (std::isfinite(actuator.drive.velocity_limit) && effort * rate > 0)
    limit *= std::clamp(1 - std::abs(rate) / actuator.drive.velocity_limit, 0.0, 1.0);
  if (actuator.servo) limit = std::min(limit, actuator.servo->effort_limit);
  return coordinate.effort_limit > 0 ? std::min(limit, coordinate.effort_limit) : limit;
}

bool has_corners(const Model& model) {
  const auto of_coordinate = [](const Coordinate& c) {
    return c.limit || c.friction != 0 || c.friction_coefficient != 0;
  };
  return !model.actuators.empty() || !model.histories.empty() || !model.slide_lines.empty() ||
         std::any_of(model.force_elements.begin(), model.force_elements.end(),
                     [](const auto& element) { return element->hits(); }) ||
         std::any_of(model.coordinates.begin(), model.coordinates.end(), of_coordinate);
}

}  // namespace

Corners::Corners(const Simulation& simulation) : may_come_(has_corners(model_of(simulation))) {
  const Model& model = model_of(simulation);
  marks_.assign(2 * model.coordinates.size() + 4 * model.actuators.size() + model.force_elements.size() + 1, kUnknown);
  last_marks_ = marks_;
  ways_.resize(model.coordinates.size() + model.actuators.size());
  begin(simulation);
}

void Corners::begin(const Simulation& simulation) {
  std::fill(ways_.begin(), ways_.end(), std::nan(""));
  look(simulation);
}

bool Corners::passed(const Simulation& simulation) {
  last_marks_.swap(marks_);
  const bool has_jumped = jumped(simulation);
  look(simulation);
  for (std::size_t i = 0; i < marks_.size(); ++i)
    if (marks_[i] != last_marks_[i] && marks_[i] != kUnknown && last_marks_[i] != kUnknown) return true;
  return has_jumped;
}

bool Corners::jumped(const Simulation& simulation) const {
  const double quarter = 0.25 * (simulation.time() - time_);
  for (const TimeFunction& history : model_of(simulation).histories) {
    std::array<double, 4> changes;
    double before = history(time_), sum = 0, largest = std::abs(before);
    for (int i = 0; i < 4; ++i) {
      const double after = history(time_ + (i + 1) * quarter);
      sum += changes[i] = std::abs(after - before);
      largest = std::max(largest, std::abs(after));
      before = after;
    }
    if (sum > kRoundOffOfSums * largest && *std::max_element(changes.begin(), changes.end()) > kJump * sum) return true;
  }
  return false;
}

void Corners::look(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  const State& state = state_of(simulation);
  const double step = simulation.time() - time_;
  time_ = simulation.time();
  auto mark = marks_.begin();
  auto way = ways_.begin();
  const auto moved = [&](double now) {
    const double change = now - *way;  // NaN if nothing is known
    *way++ = now;
    return change;
  };
  const auto direction = [](bool has_friction, bool rests, double change) {
    return !has_friction || std::isnan(change) ? kUnknown : rests ? 0 : sign(change);
  };
  for (std::size_t c = 0; c < model.coordinates.size(); ++c) {
    const Coordinate& coordinate = model.coordinates[c];
    const double change = moved(simulation.position(c));
    *mark++ = coordinate.limit ? side(simulation.position(c), coordinate.limit->lower, coordinate.limit->upper) : 0;
    *mark++ = direction(coordinate.friction != 0 || coordinate.friction_coefficient != 0, state.rests[c] > 0, change);
  }
  for (std::size_t a = 0; a < model.actuators.size(); ++a) {
    const Actuator& actuator = model.actuators[a];
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const double position = simulation.position(actuator.coordinate), effort = state.efforts[actuator.coordinate];
    const double change = moved(actuator.drive.gear ? state.actuators[a].angle : position);
    const double limit = limit_of(actuator, coordinate, effort, std::isnan(change) ? 0 : change / step);
    *mark++ = std::isnan(change) ? kUnknown : side(effort, -limit * (1 - kAtLimit), limit * (1 - kAtLimit));
    *mark++ = direction(actuator.drive.friction != 0 || actuator.drive.loss != 0, state.actuators[a].rest > 0, change);
    const double gear_play = actuator.drive.gear ? 0.5 * actuator.drive.gear->backlash : 0;
    *mark++ = gear_play > 0 ? side(state.actuators[a].angle - position, -gear_play, gear_play) : 0;
    const double spring_play = actuator.spring ? 0.5 * actuator.spring->elasticity.backlash : 0;
    *mark++ = spring_play > 0 ? side(position - actuator.spring->rest, -spring_play, spring_play) : 0;
  }
  const double* memory = state.force_memory.data();
  for (const auto& element : model.force_elements) {
    *mark++ = element->hits() && element->remembers(memory) ? 1 : 0;
    memory += element->memory_size();
  }
  *mark++ = static_cast<int>(state.left_lines.size()) + kUnknown + 1;
}

}  // namespace flexarm
