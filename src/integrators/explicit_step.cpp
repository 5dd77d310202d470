#include "integrators/explicit_step.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "integrators/explicit_loads.h"
#include "integrators/explicit_obstacle.h"
#include "joints/joint_kinematics.h"
#include "math/so3.h"
#include "math/step_end.h"
#include "schemes/explicit_tableau.h"

namespace flexarm {

namespace {

/// @throws ModelError naming what explicit schemes cannot simulate, if the model has some of it
const Model& suitable(const Model& model, const Scheme& scheme) {
  if (const char* what = explicit_obstacle(model))
    throw ModelError(fmt::format(
        "<integrator>: scheme '{}' has no {}; take one of the energy-momentum family, such as em", scheme.name, what));
  return model;
}

/// Relative to a step: how far from its ends functions of time are evaluated to find their limits there. It is far
/// above the round-off of times at which functions jump.
constexpr double kInwards = 1e-9;

/// Places of the margins of efforts of the scene that are cut and that no motor gives.
std::vector<int> limits_of_efforts(const Model& model, ExplicitMargins& margins) {
  std::vector<int> places;
  for (const Coordinate& coordinate : model.coordinates) {
    const bool is_cut = coordinate.effort >= 0 && coordinate.actuator < 0 && coordinate.effort_limit > 0;
    places.push_back(is_cut ? margins.add() : ExplicitMargins::kNone);
  }
  return places;
}

std::vector<int> plays_of_gears(const Model& model, ExplicitMargins& margins) {
  std::vector<int> places;
  for (const Actuator& actuator : model.actuators) {
    const bool has_play = actuator.drive.gear && actuator.drive.gear->backlash > 0;
    places.push_back(has_play ? margins.add() : ExplicitMargins::kNone);
  }
  return places;
}

std::vector<int> rubbing_joints(const Model& model, ExplicitMargins& margins) {
  std::vector<int> places;
  for (const Coordinate& coordinate : model.coordinates) {
    const bool rubs = coordinate.friction > 0 && !coordinate.sticks && !is_held(model, coordinate);
    places.push_back(rubs ? margins.add_reversal() : ExplicitMargins::kNone);
  }
  return places;
}

std::vector<int> rubbing_rotors(const Model& model, ExplicitMargins& margins) {
  std::vector<int> places;
  for (const Actuator& actuator : model.actuators) {
    const bool rubs = actuator.drive.gear && actuator.drive.friction + actuator.drive.loss > 0;
    places.push_back(rubs ? margins.add_reversal() : ExplicitMargins::kNone);
  }
  return places;
}

int position_count(JointMapKind kind) {
  switch (kind) {
    case JointMapKind::Scalar:
      return 1;
    case JointMapKind::Spherical:
      return 4;
    case JointMapKind::Free:
      return 7;
    default:
      return 0;
  }
}

}  // namespace

ExplicitStep::ExplicitStep(const Model& model, const Scheme& scheme)
    : model_(suitable(model, scheme)),
      tableau_(*scheme.tableau),
      bodies_(model),
      dependent_(model, bodies_, tableau_),
      motors_(model, tableau_, margins_),
      rotors_(model),
      reactions_(model),
      limits_(limits_of_efforts(model, margins_)),
      plays_(plays_of_gears(model, margins_)),
      rubbing_joints_(rubbing_joints(model, margins_)),
      rubbing_rotors_(rubbing_rotors(model, margins_)),
      events_(model, margins_.numbers().size()),
      poses_(model.nodes.size()),
      velocities_(model.nodes.size()),
      released_(model.joints.size()),
      applied_(model.coordinates.size()),
      impulses_(model.actuators.size()),
      values_(model.histories.size()) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const std::optional<double> constant = model.histories[i].constant();
    if (!constant) varying_.push_back(static_cast<int>(i));
    values_[i] = constant.value_or(0);
  }
  last_values_ = values_;
  for (const JointMap& joint : model.joints) {
    joints_.push_back({static_cast<int>(rates_), bodies_.first_rate(static_cast<int>(joints_.size())), joint.kind});
    rates_ += position_count(joint.kind);
  }
  work_ = rates_ + bodies_.rate_count();
  integrals_ = work_ + 2;
  own_ = integrals_ + model.actuators.size();
  efforts_.resize(bodies_.rate_count());
  no_efforts_.resize(bodies_.rate_count());
  armatures_.resize(bodies_.rate_count());
  places_.reserve(model.coordinates.size());
  for (const Coordinate& coordinate : model.coordinates) {
    places_.push_back(rate_of(coordinate));
    if (places_.back() >= 0) armatures_[places_.back()] = armature(model, coordinate);
  }
  for (std::vector<double>* numbers : {&begin_, &stage_, &before_, &last_change_})
    numbers->resize(own_ + rotors_.size());
  changes_.assign(tableau_.weights.size(), begin_);
  last_commands_.resize(model.coordinates.size());
}

int ExplicitStep::rate_of(const Coordinate& coordinate) const {
  return is_held(model_, coordinate) ? -1 : joints_[coordinate.joint].first_rate + coordinate.component;
}

// ---------------------------------------------------------------- numbers and state

void ExplicitStep::pack(const State& state) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = node_pose(state.nodes[i]);
    velocities_[i] = spatial_velocity(state.nodes[i]);
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    released_[j] = state.released[j];
    const ReleasedVector rates = released_rates(model_, static_cast<int>(j), poses_, released_[j], velocities_);
    std::copy_n(rates.data(), released_count(joints_[j].kind), begin_.data() + rates_ + joints_[j].first_rate);
  }
  write_positions(begin_);
  for (std::size_t i = 0; i < state.actuators.size(); ++i) begin_[integrals_ + i] = state.actuators[i].servo.integral;
  rotors_.pack(state, begin_.data() + own_);
}

void ExplicitStep::write_positions(std::vector<double>& numbers) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    double* to = numbers.data() + joints_[j].first_position;
    if (joints_[j].kind == JointMapKind::Scalar) *to++ = released_[j].displacement[0];
    if (joints_[j].kind == JointMapKind::Free) to = std::copy_n(released_[j].displacement.data(), 3, to);
    if (position_count(joints_[j].kind) >= 4) std::copy_n(released_[j].rotation.coeffs().data(), 4, to);
  }
}

void ExplicitStep::unpack(const std::vector<double>& numbers) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const double* from = numbers.data() + joints_[j].first_position;
    if (joints_[j].kind == JointMapKind::Scalar) released_[j].displacement[0] = *from++;
    if (joints_[j].kind == JointMapKind::Free) {
      released_[j].displacement = Eigen::Map<const Vector3>(from);
      from += 3;
    }
    if (position_count(joints_[j].kind) >= 4)
      released_[j].rotation = Quaternion(from[3], from[0], from[1], from[2]).normalized();
  }
}

void ExplicitStep::normalise(std::vector<double>& numbers) const {
  for (const Joint& joint : joints_) {
    const int count = position_count(joint.kind);
    if (count >= 4) Eigen::Map<Eigen::Vector4d>(numbers.data() + joint.first_position + count - 4).normalize();
  }
}

/// Whether the state is where the last step left it. Commands may have changed.
bool ExplicitStep::is_as_left(const State& state) const {
  const auto same = [](const NodeState& a, const NodeState& b) {
    return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs() && a.velocity == b.velocity &&
           a.angular_velocity == b.angular_velocity;
  };
  for (std::size_t i = 0; i < state.actuators.size(); ++i)
    if (state.actuators[i].servo.integral != stage_[integrals_ + i]) return false;
  return rotors_.are_those_of(state, stage_.data() + own_) &&
         std::equal(state.nodes.begin(), state.nodes.end(), last_nodes_.begin(), last_nodes_.end(), same);
}

/// Whether the derivatives at the end of the last step hold at the beginning of this one.
bool ExplicitStep::acts_as_before(const State& state) const {
  if (values_ != last_values_ || dependent_.has_motions() || !motors_.has_kept_inputs()) return false;
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  return state.time == last_time_ && state.wrenches.empty() &&
         std::equal(state.commands.begin(), state.commands.end(), last_commands_.begin(), same);
}

// ---------------------------------------------------------------- derivatives

/// Evaluates all functions of time at a part of a step. At its ends these are the limits from inside, since functions
/// may jump there: found by a straight line through two points inside, whose error is far below round-off.
void ExplicitStep::find_values(double begin, double step, double part) {
  const double time = part == 1 ? step_end(begin, step) : begin + part * step;
  const double inwards = part == 0 ? kInwards * step : part == 1 ? -kInwards * step : 0;
  for (const int i : varying_) {
    const TimeFunction& function = model_.histories[i];
    values_[i] = inwards == 0 ? function(time) : 2 * function(time + inwards) - function(time + 2 * inwards);
  }
}

void ExplicitStep::find_inputs(const State& state, double step, std::size_t stage) {
  const double part = stage < tableau_.times.size() ? tableau_.times[stage] : 1;
  find_values(state.time, step, part);
  motors_.set_instant(state, stage, part, values_);
}

/// Sets the bodies to these numbers, in which it sets dependent coordinates.
bool ExplicitStep::place(std::size_t stage, std::vector<double>& numbers) {
  unpack(numbers);
  double* rates = numbers.data() + rates_;
  if (!dependent_.any()) {
    bodies_.set(released_, rates);
    return true;
  }
  const bool is_closed = dependent_.place(stage, values_, released_, rates, bodies_);
  write_positions(numbers);
  return is_closed;
}

bool ExplicitStep::evaluate(const State& state, std::size_t stage, std::vector<double>& numbers,
                            std::vector<double>& change) {
  if (!place(stage, numbers)) return false;
  const double* rates = numbers.data() + rates_;
  change[work_] = change[work_ + 1] = 0;
  add_loads(state, change);
  find_efforts(state, numbers, change);
  accelerate(stage, efforts_.data(), change);
  add_drives(rates, change);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const double* rate = rates + joints_[j].first_rate;
    double* to = change.data() + joints_[j].first_position;
    if (joints_[j].kind == JointMapKind::Scalar) *to++ = *rate;
    if (joints_[j].kind == JointMapKind::Free) {
      to = std::copy_n(rate, 3, to);
      rate += 3;
    }
    if (position_count(joints_[j].kind) < 4) continue;
    // The angular velocity is given in the joint frame, before the rotation.
    const Quaternion half(0, 0.5 * rate[0], 0.5 * rate[1], 0.5 * rate[2]);
    std::copy_n((half * released_[j].rotation).coeffs().data(), 4, to);
  }
  return true;
}

void ExplicitStep::accelerate(std::size_t stage, const double* efforts, std::vector<double>& change) {
  if (dependent_.any())
    dependent_.accelerate(stage, efforts, armatures_.data(), bodies_, change.data() + rates_);
  else
    bodies_.accelerate(efforts, armatures_.data(), change.data() + rates_);
}

/// Sets the efforts of motions, and adds their work to `change`.
void ExplicitStep::add_drives(const double* rates, std::vector<double>& change) {
  if (!dependent_.has_motions()) return;
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
    if (model_.coordinates[i].motion < 0 || places_[i] < 0) continue;
    applied_[i] = dependent_.drive(places_[i]);
    change[work_] += applied_[i] * rates[places_[i]];
  }
}

// ---------------------------------------------------------------- the step

/// Begins a step of dependent coordinates at the numbers `begin_`. Adds the work by which motions jump to `work`.
bool ExplicitStep::begin_dependent(const State& state, double step, double& work) {
  double* rates = begin_.data() + rates_;
  unpack(begin_);
  if (!dependent_.begin(state.time, step, released_, rates, bodies_)) return false;
  before_ = begin_;
  if (!place(0, begin_)) return false;
  work += dependent_.strike(before_.data() + rates_, armatures_.data(), bodies_, rates);
  return true;
}

/// Finds the impulses of servos at the beginning of the step (stage 0), or later in it: of motors, and on rates.
/// Returns whether there are any.
bool ExplicitStep::find_impulses(const State& state, std::size_t stage) {
  std::fill(efforts_.begin(), efforts_.end(), 0.0);
  bool jumps = false;
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    impulses_[i] = stage == 0 ? motors_.first_impulse(i, state) : motors_.later_impulse(i, state, tableau_.weights);
    jumps = jumps || impulses_[i] != 0;
    if (rotors_.place(i) < 0) efforts_[places_[model_.actuators[i].coordinate]] += impulses_[i];
  }
  return jumps;
}

/// Half of the work of impulses on rotors with a motion of their own, if all of it were done at their present rates.
double ExplicitStep::half_work_on_rotors(const std::vector<double>& numbers) const {
  double work = 0;
  for (std::size_t i = 0; i < impulses_.size(); ++i)
    if (rotors_.place(i) >= 0) work += 0.5 * impulses_[i] * rotors_.motion(i, numbers.data() + own_, {}, bodies_).rate;
  return work;
}

/// Where set points jump at the beginning of the step (stage 0), or later in it, changes the rates by the impulses of
/// servos: among these numbers, which are those at the stage. Returns false if a loop cannot be closed.
bool ExplicitStep::strike(const State& state, std::size_t stage, std::vector<double>& numbers) {
  if (!find_impulses(state, stage)) return true;
  // Accelerations are affine in efforts, so the change of rates is a difference of two.
  if (!place(stage, numbers)) return false;
  accelerate(stage, no_efforts_.data(), changes_[0]);
  if (!place(stage, numbers)) return false;
  numbers[work_] += half_work_on_rotors(numbers);
  for (std::size_t i = 0; i < impulses_.size(); ++i)
    if (rotors_.place(i) >= 0) rotors_.strike(i, impulses_[i], numbers.data() + own_, bodies_);
  accelerate(stage, efforts_.data(), last_change_);
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const double change = last_change_[rates_ + i] - changes_[0][rates_ + i];
    numbers[work_] += efforts_[i] * (numbers[rates_ + i] + 0.5 * change);
    numbers[rates_ + i] += change;
  }
  if (rotors_.size() == 0) return true;
  bodies_.set(released_, numbers.data() + rates_);
  numbers[work_] += half_work_on_rotors(numbers);
  return true;
}

void ExplicitStep::write(State& state, double step) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const int node = model_.joints[j].slave;
    state.released[j] = released_[j];
    NodeState& to = state.nodes[node];
    to.position = bodies_.position(node);
    to.orientation = so3::nearer_of_two(Quaternion(bodies_.rotation(node)).normalized(), to.orientation);
    const Matrix3 to_node = bodies_.rotation(node).transpose();
    to.velocity = bodies_.velocity(node).head<3>();
    to.angular_velocity = to_node * bodies_.velocity(node).tail<3>();
    to.mean_spin = bodies_.velocity(node).tail<3>();
    to.acceleration = bodies_.acceleration(node).head<3>();
    to.angular_acceleration = to_node * bodies_.acceleration(node).tail<3>();
  }
  for (std::size_t i = 0; i < applied_.size(); ++i) state.efforts[i] = applied_[i];
  write_actuators(state, step);
  state.history.clear();
  state.time = last_time_ = step_end(state.time, step);
  std::copy(state.commands.begin(), state.commands.end(), last_commands_.begin());
  last_nodes_ = state.nodes;
  last_values_ = values_;
  motors_.keep_inputs();
  if (reactions_.any()) write_reactions(state);
}

void ExplicitStep::write_actuators(State& state, double step) {
  const double* own = stage_.data() + own_;
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    ActuatorState& actuator = state.actuators[i];
    const ExplicitRotors::Motion link = link_motion(model_.actuators[i].coordinate, stage_);
    const int place = rotors_.place(i);
    actuator.angle = place < 0 ? link.angle : own[place];
    actuator.rate = place < 0 ? link.rate : own[place + 1];
    double& integral = stage_[integrals_ + i];
    motors_.accept(i, step, rotors_.motion(i, own, link, bodies_), link, integral, actuator.servo);
    integral = actuator.servo.integral;
  }
}

/// Inverse dynamics at the end of the step, with the accelerations there.
void ExplicitStep::write_reactions(State& state) {
  const double* rate_changes = last_change_.data() + rates_;
  bodies_.set(released_, stage_.data() + rates_);
  for_each_load(model_, state, values_, bodies_,
                [&](const NodalLoad& load, const Vector6& wrench) { bodies_.add_force(load.node, wrench); });
  rotors_.add_moments(bodies_);
  if (dependent_.any()) dependent_.add_closure_forces(bodies_);
  bodies_.set_accelerations(rate_changes);
  bodies_.find_needed_efforts(rate_changes, armatures_.data(), efforts_.data());
  reactions_.accept(bodies_, dependent_.closure_forces(), values_, state);
}

}  // namespace flexarm
