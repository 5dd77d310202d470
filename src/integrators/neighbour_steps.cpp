#include "integrators/neighbour_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "joints/joint_kinematics.h"
#include "math/so3.h"
#include "model/state_numbers.h"

namespace flexarm {
namespace {

/// Updates are repeated until the expected next one is shorter than kRemainder, or until updates below kStagnation
/// shrink no further. The limits are small because the remaining error has the same sign in each step and is divided by
/// the difference of the neighbours, 1e-5.
constexpr double kRemainder = 1e-18, kStagnation = 1e-12, kStalled = 0.5;
constexpr int kMostUpdates = 30;
/// Neighbours are put beside the run again after this number of sub-steps. For a stiffness that differs by a factor e,
/// the phases of vibrations differ by up to half a radian per step. The error of the derivative is then (sub-steps / 2
/// difference)^2 / 6.
constexpr long kTogether = 8;
/// Number of updates that a neighbour needs if the factors were made in the same step.
constexpr int kFewestUpdates = 2;

/// After this many contact times, a coordinate on its stop no longer oscillates.
constexpr double kLongestHit = 6;

/// Whether the neighbours have the same commands and the same origin as the run.
bool obey_the_same(const Direction& direction, const State& state) {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const auto like = [&](const auto& a, const auto& b, const auto& is_same) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
  };
  return std::all_of(direction.neighbours.begin(), direction.neighbours.end(), [&](const Neighbour& neighbour) {
    const State& own = neighbour.state;
    return own.origin == state.origin && like(own.commands, state.commands, same) &&
           like(own.wrenches, state.wrenches,
                [](const NodalLoad& a, const NodalLoad& b) {
                  return a.node == b.node && a.arm == b.arm && a.force == b.force && a.moment == b.moment &&
                         a.pull.target == b.pull.target && a.pull.stiffness == b.pull.stiffness &&
                         a.pull.damping == b.pull.damping;
                }) &&
           like(own.actuators, state.actuators, [&](const ActuatorState& a, const ActuatorState& b) {
             const ServoCommand &x = a.servo, &y = b.servo;
             return same(x.set_point, y.set_point) && x.set_rate == y.set_rate &&
                    x.set_acceleration == y.set_acceleration && x.set_time == y.set_time && x.law == y.law &&
                    x.off == y.off;
           });
  });
}

/// Chooses that of the two quaternions of a rotation that is closer to `other`.
void take_sign(Quaternion& rotation, const Quaternion& other) {
  if (rotation.dot(other) < 0) rotation.coeffs() *= -1;
}

}  // namespace

NeighbourSteps::NeighbourSteps(const Model& model, const Scheme& scheme)
    : model_(model),
      system_(model, scheme),
      update_(system_.degrees_of_freedom().unknowns),
      poses_(model.nodes.size()) {
  if (scheme.interpolation == Interpolation::Iterative)
    throw ModelError(
        fmt::format("runs of scheme '{}' have no derivatives: with interpolation=\"iterative\" they "
                    "depend on Newton's iterates",
                    scheme.name));
  for (IncrementHistory* history : {&made_, &guess_}) history->push(0, system_.degrees_of_freedom().unknowns);
  if (scheme.is_composition) return;  // it has backward sub-steps, which events cannot divide
  march_ = std::make_unique<EventMarch>(model, scheme);
  if (!march_->has_corners()) march_.reset();
  if (march_) system_.hold_modes(&march_->modes());
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.limit) longest_hit_ = std::max(longest_hit_, kLongestHit * hit_time(*coordinate.limit));
}

void NeighbourSteps::measure(Direction& direction, const State& state) {
  numbers_.clear();
  for_each_number(state, [&](const char*, double number) { numbers_.push_back(number); });
  std::vector<double>& sum = direction.derivative;
  sum.assign(numbers_.size(), 0.0);
  for (Neighbour& neighbour : direction.neighbours) {
    neighbour.state.wrenches = state.wrenches;  // they may have been replaced since the last step
    for (std::size_t n = 0; n < state.nodes.size(); ++n)
      take_sign(neighbour.state.nodes[n].orientation, state.nodes[n].orientation);
    for (std::size_t j = 0; j < state.released.size(); ++j)
      take_sign(neighbour.state.released[j].rotation, state.released[j].rotation);
    const double weight = neighbour.weight / direction.difference;
    std::size_t i = 0;
    for_each_number(neighbour.state, [&](const char*, double number) {
      assert(i < numbers_.size() && "of a like model");
      sum[i] += weight * (number - numbers_[i]);
      ++i;
    });
  }
  for (double& number : sum)
    if (!std::isfinite(number)) number = 0;  // NaN stands for commands that are not given
}

void NeighbourSteps::place(Direction& direction, const State& state) {
  for (Neighbour& neighbour : direction.neighbours) {
    const double way = neighbour.offset * direction.difference;
    State& own = neighbour.state;
    own = state;
    std::size_t i = 0;
    for_each_number(own, [&](const char*, double& number) {
      assert(i < direction.derivative.size() && "measure() has made it");
      if (const double change = way * direction.derivative[i++]; change != 0) number += change;
    });
    for (NodeState& node : own.nodes) node.orientation.normalize();
    for (Released& released : own.released) released.rotation.normalize();
    place_slaves(neighbour);
  }
}

/// Places slaves exactly where their joints have them. Otherwise an error of third order would be divided by the step.
void NeighbourSteps::place_slaves(Neighbour& neighbour) {
  const Model& model = neighbour.system ? neighbour.system->configuration().model() : model_;
  State& own = neighbour.state;
  for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = node_pose(own.nodes[i]);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (model.joints[j].kind == JointMapKind::Slide) continue;  // a slave may lie slightly beside its line
    const int slave = model.joints[j].slave;
    NodePose& pose = poses_[slave];
    const Quaternion before = pose.orientation;
    pose = slave_pose(model, static_cast<int>(j), poses_, own.released[j]);
    own.nodes[slave].position = pose.position;
    own.nodes[slave].orientation = so3::nearer_of_two(pose.orientation, before);
  }
}

double NeighbourSteps::distance(const Direction& direction, const State& state, double step) const {
  double largest = 0;
  for (const Neighbour& neighbour : direction.neighbours) {
    for (std::size_t i = 0; i < state.nodes.size(); ++i) {
      const NodeState &a = neighbour.state.nodes[i], &b = state.nodes[i];
      largest = std::max({largest, (a.position - b.position).norm() / model_.length_scale,
                          2 * (a.orientation.coeffs() - b.orientation.coeffs()).norm(),
                          step * (a.velocity - b.velocity).norm() / model_.length_scale,
                          step * (a.angular_velocity - b.angular_velocity).norm()});
    }
    for (std::size_t j = 0; j < state.released.size(); ++j) {
      const Released &a = neighbour.state.released[j], &b = state.released[j];
      const double unit = std::min(1.0, model_.length_scale);
      largest = std::max({largest, (a.displacement - b.displacement).norm() * unit / model_.length_scale,
                          2 * (a.rotation.coeffs() - b.rotation.coeffs()).norm()});
    }
  }
  return largest;
}

void NeighbourSteps::begin_step() {
  for_each_neighbour([](Neighbour& neighbour) {
    neighbour.state.drives.begin();
    neighbour.state.transmitted.begin();
  });
  for (Way& way : ways_) {
    const auto begin = [](State& state) {
      state.drives.begin();
      state.transmitted.begin();
    };
    begin(way.ahead);
    for (State& state : way.neighbours) begin(state);
  }
}

void NeighbourSteps::end_step(double duration) {
  const auto end = [&](State& state) {
    state.drives.end(duration);
    state.transmitted.end(duration);
  };
  for_each_neighbour([&](Neighbour& neighbour) { end(neighbour.state); });
  if (!is_ahead_) return;
  for (Way& way : ways_) {
    end(way.ahead);
    for (State& state : way.neighbours) end(state);
  }
}

void NeighbourSteps::keep() {
  std::size_t i = 0;
  for_each_neighbour([&](Neighbour& neighbour) {
    if (kept_.size() <= i) kept_.emplace_back();
    kept_[i++] = neighbour.state;
  });
}

void NeighbourSteps::take_back() {
  std::size_t i = 0;
  for_each_neighbour([&](Neighbour& neighbour) { neighbour.state = kept_[i++]; });
}

void NeighbourSteps::put_beside(Direction& direction, const State& state, double step) {
  const double way = direction.has_free_difference ? distance(direction, state, step) : 0;
  if (way > 0) direction.difference *= kDistance / way;
  place(direction, state);
}

void NeighbourSteps::follow(const State& state, const StepSystem& solved) {
  if (!lost_.empty() || directions_.empty()) return;
  const double step = solved.configuration().step();
  settle(state);
  note_motors(state);
  note_hits(state);
  if (is_in_hit_ && ways_[0].ahead.origin == state.origin) return go_over_events(state, step);
  is_in_hit_ = false;
  for (Direction& direction : directions_) {
    if (followed_ % kTogether != 0 && obey_the_same(direction, state)) continue;
    measure(direction, state);
    put_beside(direction, state, step);
  }
  if (march_ && followed_ == 0) march_->restart(state);
  ++followed_;
  const bool is_led = solved.configuration().led_to();  // so short that nothing else happens
  if (march_ && was_led_) march_->restart(state);
  was_led_ = is_led;
  if (march_ && !is_led && march_->is_wanted(state, solved)) return go_over_events(state, step);
  if (!march_) note_stops(state, solved);
  follow_piece(state, solved);
}

void NeighbourSteps::follow_piece(const State& state, const StepSystem& solved) {
  if (!lost_.empty()) return;
  const double step = solved.configuration().step();
  solved.remember_increments(made_);
  const int count = static_cast<int>(directions_.size()) * 2;
  const bool are_worn = updates_ > kFewestUpdates * count + system_.tangent().cost_of_factors();
  if ((are_worn || factorised_step_ != step || !system_.tangent_holds()) && !make_factors(state, solved))
    return lose("the tangent of a step is singular");
  updates_ = 0;
  for_each_neighbour([&](Neighbour& neighbour) {
    const std::string why = lost_.empty() ? advance(neighbour, state, solved) : "";
    if (!why.empty()) lose(fmt::format("at t = {:.9g} s {}", state.time + step, why));
  });
}

/// Where motions have kinks, laws take the branches of the run, which no event has announced.
void NeighbourSteps::hold_modes(StepSystem& system, const StepSystem& solved) const {
  if (march_) system.hold_modes(solved.configuration().led_to() ? nullptr : &march_->modes());
}

bool NeighbourSteps::make_factors(const State& state, const StepSystem& solved) {
  hold_modes(system_, solved);
  system_.begin_beside(solved, state, made_);
  factorised_step_ = 0;
  if (!system_.evaluate(true) || !system_.tangent().factorise()) return false;
  factorised_step_ = solved.configuration().step();
  return true;
}

std::string NeighbourSteps::advance(Neighbour& neighbour, const State& state, const StepSystem& solved) {
  StepSystem& system = neighbour.system ? *neighbour.system : system_;
  hold_modes(system, solved);
  const double step = solved.configuration().step();
  guess_ = made_;
  guess_.steps[0] = step;
  if (state.history.holds_for(update_.size()) && state.history.steps[0] == step)  // same difference as in the last step
    for (std::size_t i = 0; i < guess_.increments[0].size(); ++i)
      guess_.increments[0][i] += neighbour.state.history.increments[0][i] - state.history.increments[0][i];
  system.begin_beside(solved, neighbour.state, guess_);
  for (int retries = 0; !solve(system); ++retries) {
    if (retries > 0 || !make_factors(state, solved))
      return "the derivative cannot be computed with the run's factorisation: the equations change within the "
             "difference";
    system.begin_beside(solved, neighbour.state, made_);
  }
  if (const char* change = system.revise()) return fmt::format("{} within the difference of neighbours", change);
  system.accept(neighbour.state);
  return "";
}

bool NeighbourSteps::solve(StepSystem& system) {
  if (update_.size() == 0) return system.evaluate(false);
  double last = 0;
  for (int k = 0; k < kMostUpdates; ++k) {
    if (!system.evaluate(false)) return false;
    update_ = -system.residual();
    if (!system_.tangent().solve(update_)) return false;
    const double norm = system.scales().norm(update_, system.configuration().step());
    if (!std::isfinite(norm)) return false;
    system.update(update_);
    ++updates_;
    const double rate = k == 0 ? 1 : norm / last;
    if (norm * std::min(rate, 1.0) <= kRemainder || (norm <= kStagnation && rate > kStalled && k > 0))
      return system.evaluate(false);
    last = norm;
  }
  return false;
}

}  // namespace flexarm
