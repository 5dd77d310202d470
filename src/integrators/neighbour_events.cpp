// NeighbourSteps: how neighbours pass events, in pieces together with a repetition of the run.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "integrators/neighbour_steps.h"
#include "model/state_numbers.h"

namespace flexarm {
namespace {

/// Pieces of a sub-step between its events. A second pass has twice as many, so that extrapolation removes most of the
/// error.
constexpr int kPieces = 4;

/// What has happened when a law changes its stage, in words.
const char* story(const Corner& corner, const Crossing& crossing) {
  if (!corner.is_friction) return crossing.to == EventMarch::kIn ? "touches its stop" : "leaves its stop";
  return crossing.to == 0 ? "sticks" : crossing.from == 0 ? "slips" : "turns back";
}

}  // namespace

void NeighbourSteps::start_ways(const State& state) {
  hit_begin_ = state.time;
  for (Way& way : ways_) {
    way.ahead = state;
    way.neighbours.resize(2 * directions_.size());
    std::size_t i = 0;
    for_each_neighbour([&](Neighbour& neighbour) { way.neighbours[i++] = neighbour.state; });
    way.stages = march_->stages();
  }
}

/// Takes over commands that the run has received since the last sub-step, and samples of sensors.
void NeighbourSteps::obey(Way& way, const State& state) {
  const auto take = [&](State& own, const State& measured) {
    own.commands = state.commands;
    own.wrenches = state.wrenches;
    own.samples = measured.samples;
    for (std::size_t i = 0; i < own.actuators.size(); ++i)
      static_cast<ServoCommand&>(own.actuators[i].servo) = state.actuators[i].servo;
  };
  take(way.ahead, state);
  std::size_t i = 0;
  for_each_neighbour([&](Neighbour& neighbour) { take(way.neighbours[i++], neighbour.state); });
}

/// The steps of the run do not end at events, so that their derivative differs from that of the motion. So the sub-step
/// is repeated in pieces that end at events, together with the neighbours, with two numbers of pieces.
void NeighbourSteps::go_over_events(const State& state, double step) {
  if (is_in_hit_)
    for (Way& way : ways_) obey(way, state);
  else
    start_ways(state);
  for (const bool is_fine : {false, true}) {
    notes_events_ = is_fine;
    go_on(ways_[is_fine], step, is_fine ? 2 * kPieces : kPieces);
    if (!lost_.empty()) return;
  }
  factorised_step_ = 0;
  is_ahead_ = true;
}

void NeighbourSteps::go_on(Way& way, double step, int pieces) {
  std::size_t i = 0;
  for_each_neighbour([&](Neighbour& neighbour) { neighbour.state = way.neighbours[i++]; });
  march_->set_stages(way.stages);
  begin_ = way.ahead;
  const std::string why = march_->go(way.ahead, step, pieces, *this);
  if (!why.empty()) lose(fmt::format("before t = {:.9g} s {}", begin_.time + step, why));
  if (!lost_.empty()) return;
  i = 0;
  for_each_neighbour([&](Neighbour& neighbour) {
    neighbour.state.time = way.ahead.time;
    (neighbour.system ? *neighbour.system : system_).remember_step(way.neighbours[i], step, neighbour.state);
    way.neighbours[i++] = neighbour.state;
  });
  system_.remember_step(begin_, step, way.ahead);
  way.stages = march_->stages();
}

/// Whether the run or a repetition is still in a hit. Within a hit, the derivatives of the pieces and those of the run
/// belong to different phases of it.
bool NeighbourSteps::hit_goes_on(const State& state) {
  if (state.time - hit_begin_ > longest_hit_) return false;
  return march_->is_hit(state, nullptr) || march_->is_hit(ways_[0].ahead, &ways_[0].stages) ||
         march_->is_hit(ways_[1].ahead, &ways_[1].stages);
}

void NeighbourSteps::settle(const State& state) {
  if (!is_ahead_ || !lost_.empty()) return;
  is_ahead_ = false;
  is_in_hit_ = hit_goes_on(state);
  coarse_.resize(directions_.size());
  for (const bool is_fine : {false, true}) {
    std::size_t i = 0;
    for_each_neighbour([&](Neighbour& neighbour) { neighbour.state = ways_[is_fine].neighbours[i++]; });
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      std::vector<double>& derivative = directions_[k].derivative;
      measure(directions_[k], ways_[is_fine].ahead);
      if (is_fine)
        for (std::size_t n = 0; n < derivative.size(); ++n) derivative[n] = (4 * derivative[n] - coarse_[k][n]) / 3;
      else
        coarse_[k] = derivative;
    }
  }
  for (Direction& direction : directions_)
    if (is_in_hit_)
      place(direction, state);
    else
      put_beside(direction, state, state.history.steps[0]);
}

void NeighbourSteps::cross(const Crossing& crossing) {
  const bool has_slope = crossing.jumps && crossing.slope < 0;
  if (has_slope) for_each_neighbour([&](Neighbour& neighbour) { jump(neighbour, crossing); });
  const Corner& corner = march_->corner(crossing.corner);
  if (corner.is_friction)
    for_each_neighbour(
        [&](Neighbour& neighbour) { neighbour.state.rests[corner.coordinate] = crossing.to == 0 ? 1 : 0; });
  if (notes_events_)
    events_.push_back(
        {crossing.time, model_.coordinates[corner.coordinate].name, story(corner, crossing), crossing.doubt});
}

/// The neighbour reaches the event earlier or later than the run by a time dt, in which its rates differ by the jump.
void NeighbourSteps::jump(Neighbour& neighbour, const Crossing& crossing) {
  const Model& model = neighbour.system ? neighbour.system->configuration().model() : model_;
  const double guard = march_->guard(crossing.corner, crossing.from, model, neighbour.state);
  const double way = -(guard - crossing.guard) / crossing.slope;
  std::size_t i = 0;
  for_each_number(neighbour.state, [&](const char*, double& number) {
    if (const double change = way * (*crossing.jump)[i++]; change != 0) number += change;
  });
  for (NodeState& node : neighbour.state.nodes) node.orientation.normalize();
  for (Released& released : neighbour.state.released) released.rotation.normalize();
}

/// Notes events of stops for schemes with backward sub-steps, which have no march.
void NeighbourSteps::note_stops(const State& state, const StepSystem& solved) {
  for (const Coordinate& coordinate : model_.coordinates) {
    if (!coordinate.limit) continue;
    const auto side = [&](const std::vector<Released>& released) {
      const double position = released[coordinate.joint].displacement[coordinate.component % 3];
      return (position > coordinate.limit->upper) - (position < coordinate.limit->lower);
    };
    const int end = side(solved.configuration().released());
    if (side(state.released) != end)
      events_.push_back(
          {state.time, coordinate.name, end == 0 ? "leaves its stop" : "touches its stop",
           "the scheme also steps backwards in time: the derivative is that of the steps, which ignore the "
           "event's time"});
  }
}

/// Notes events of friction within motors, which has no march. Derivatives are those of the steps.
void NeighbourSteps::note_motors(const State& state) {
  motor_rests_.resize(state.actuators.size(), -1);
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    const double rest = state.actuators[i].rest;
    if (motor_rests_[i] >= 0 && rest != motor_rests_[i])
      events_.push_back(
          {state.time, model_.coordinates[model_.actuators[i].coordinate].name,
           rest > 0 ? "its motor sticks" : "its motor slips",
           "friction within a motor: the derivative is that of the steps, which ignore the event's time"});
    motor_rests_[i] = rest;
  }
}

/// Notes hits between links, which have no march. A hit has an error of about one percent, which depends on the part of
/// a step in which it begins.
void NeighbourSteps::note_hits(const State& state) {
  const ForceElementList& elements = model_.force_elements;
  if (touches_.empty()) {  // contacts at the start are no hits
    touches_.assign(elements.size(), 1);
    return;
  }
  const double* memory = state.force_memory.data();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool touches = elements[i]->hits() && elements[i]->remembers(memory);
    memory += elements[i]->memory_size();
    const bool begins = touches && touches_[i] == 0;
    touches_[i] = touches ? 1 : 0;
    if (begins)
      events_.push_back({state.time, fmt::format("{}", fmt::join(elements[i]->links(), " and ")), "hit each other",
                         "the derivative is that of the steps, and depends on the time of the hit within its step"});
  }
}

}  // namespace flexarm
