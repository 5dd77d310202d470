#include "integrators/explicit_step.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "elements/load.h"
#include "flexarm/model/model_error.h"
#include "integrators/explicit_obstacle.h"
#include "integrators/step_histories.h"
#include "joints/joint_forces.h"
#include "joints/joint_kinematics.h"
#include "math/so3.h"
#include "model/carried_origin.h"
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
      motors_(model, tableau_),
      poses_(model.nodes.size()),
      velocities_(model.nodes.size()),
      released_(model.joints.size()),
      applied_(model.coordinates.size()),
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
  efforts_.resize(bodies_.rate_count());
  no_efforts_.resize(bodies_.rate_count());
  armatures_.resize(bodies_.rate_count());
  for (const Coordinate& coordinate : model.coordinates) {
    armatures_[joints_[coordinate.joint].first_rate + coordinate.component] = armature(model, coordinate);
    penalties_.push_back(stop_penalty(coordinate, scheme.contact_time));
  }
  for (std::vector<double>* numbers : {&begin_, &stage_, &before_, &last_change_})
    numbers->resize(integrals_ + model.actuators.size());
  changes_.assign(tableau_.weights.size(), begin_);
  last_commands_.resize(model.coordinates.size());
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
  return std::equal(state.nodes.begin(), state.nodes.end(), last_nodes_.begin(), last_nodes_.end(), same);
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
  const double time = begin + part * step, inwards = part == 0 ? kInwards * step : part == 1 ? -kInwards * step : 0;
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
    const Coordinate& coordinate = model_.coordinates[i];
    if (coordinate.motion < 0) continue;
    const int at = joints_[coordinate.joint].first_rate + coordinate.component;
    applied_[i] = dependent_.drive(at);
    change[work_] += applied_[i] * rates[at];
  }
}

/// Sets the efforts on all rates. Adds their work and what they dissipate to `change`.
void ExplicitStep::find_efforts(const State& state, const std::vector<double>& numbers, std::vector<double>& change) {
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[i];
    const int at = joints_[coordinate.joint].first_rate + coordinate.component;
    const double rate = numbers[rates_ + at];
    const double of_scene = coordinate.effort < 0 ? 0 : values_[coordinate.effort];
    applied_[i] = applied_effort(coordinate, state.commands[i], of_scene);
    const double position = coordinate.is_angle ? 0 : released_[coordinate.joint].displacement[coordinate.component];
    if (coordinate.motion >= 0) {
      applied_[i] = 0;  // until the motion is known to need one
    } else if (coordinate.actuator >= 0) {
      const std::size_t integral = integrals_ + coordinate.actuator;
      applied_[i] =
          motors_.effort(coordinate.actuator, state, applied_[i], position, rate, numbers[integral], change[integral]);
    }
    double& effort = efforts_[at] = applied_[i];
    change[work_] += applied_[i] * rate;
    if (resists(coordinate)) {
      CoordinateStep now{position, position, rate, 1};
      now.at_end = true;
      const double passive = passive_effort(coordinate, penalties_[i], now).effort;
      now.increment = 0;
      const double elastic = passive_effort(coordinate, penalties_[i], now).effort;
      effort += passive;
      change[work_ + 1] -= (passive - elastic) * rate;
    }
    if (coordinate.actuator < 0 || !model_.actuators[coordinate.actuator].spring) continue;
    const JointSpring& spring = *model_.actuators[coordinate.actuator].spring;
    effort -= spring.elasticity.stiffness * (position - spring.rest) + spring.elasticity.damping * rate;
    change[work_ + 1] += spring.elasticity.damping * rate * rate;
  }
}

void ExplicitStep::add_loads(const State& state, std::vector<double>& change) {
  for (const NodalLoad& load : model_.loads) add_load(load, values_[load.history], change);
  for (const NodalLoad& load : state.wrenches) {
    add_load(load, 1, change);
    if (load.pull.acts()) add_pull(load, world_origin(model_, state), change);
  }
}

void ExplicitStep::add_load(const NodalLoad& load, double scale, std::vector<double>& change) {
  const Matrix3& rotation = bodies_.rotation(load.node);
  add_wrench(load.node, load_action(load, scale, rotation, rotation, LoadPoint::End).wrench, change);
}

void ExplicitStep::add_pull(const NodalLoad& load, const Vector3& origin, std::vector<double>& change) {
  const Vector3 arm = bodies_.rotation(load.node) * load.arm;
  const Vector6& velocity = bodies_.velocity(load.node);
  const Vector3 place = origin + bodies_.position(load.node) + arm,
                moving = velocity.head<3>() + velocity.tail<3>().cross(arm),
                force = load.pull.stiffness * (load.pull.target - place) - load.pull.damping * moving;
  Vector6 wrench;
  wrench << force, arm.cross(force);
  add_wrench(load.node, wrench, change);
}

void ExplicitStep::add_wrench(int node, const Vector6& wrench, std::vector<double>& change) {
  bodies_.add_force(node, wrench);
  change[work_] += wrench.dot(bodies_.velocity(node));
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

/// Where set points jump at the beginning of the step (stage 0), or later in it, changes the rates by the impulses of
/// servos: among these numbers, which are those at the stage. Returns false if a loop cannot be closed.
bool ExplicitStep::strike(const State& state, std::size_t stage, std::vector<double>& numbers) {
  std::fill(efforts_.begin(), efforts_.end(), 0.0);
  bool jumps = false;
  for (std::size_t i = 0; i < model_.actuators.size(); ++i) {
    const double impulse =
        stage == 0 ? motors_.first_impulse(i, state) : motors_.later_impulse(i, state, tableau_.weights);
    const Coordinate& coordinate = model_.coordinates[model_.actuators[i].coordinate];
    efforts_[joints_[coordinate.joint].first_rate + coordinate.component] += impulse;
    jumps = jumps || impulse != 0;
  }
  if (!jumps) return true;
  // Accelerations are affine in efforts, so the change of rates is a difference of two.
  if (!place(stage, numbers)) return false;
  accelerate(stage, no_efforts_.data(), changes_[0]);
  if (!place(stage, numbers)) return false;
  accelerate(stage, efforts_.data(), last_change_);
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const double change = last_change_[rates_ + i] - changes_[0][rates_ + i];
    numbers[work_] += efforts_[i] * (numbers[rates_ + i] + 0.5 * change);
    numbers[rates_ + i] += change;
  }
  return true;
}

StepResult::Reason ExplicitStep::advance(State& state, double step, bool reuses) {
  using Reason = StepResult::Reason;
  const bool goes_on = reuses && is_as_left(state);
  const auto fail = [&](Reason reason) {
    last_nodes_.clear();  // what was known at the end of the last step is lost
    return reason;
  };
  if (goes_on)
    begin_ = stage_;
  else
    pack(state);
  begin_[work_] = begin_[work_ + 1] = 0;
  motors_.begin(state, step);
  find_inputs(state, step, 0);
  if (dependent_.any() && !begin_dependent(state, step, begin_[work_])) return fail(Reason::DeadPoint);
  if (!strike(state, 0, begin_)) return fail(Reason::DeadPoint);
  const std::size_t stages = changes_.size();
  if (goes_on && acts_as_before(state))
    changes_[0] = last_change_;
  else if (!evaluate(state, 0, begin_, changes_[0]))
    return fail(Reason::DeadPoint);
  for (std::size_t s = 1; s <= stages; ++s) {
    const std::vector<double>& weights = s < stages ? tableau_.stages[s] : tableau_.weights;
    stage_ = begin_;
    for (std::size_t r = 0; r < weights.size(); ++r) {
      if (weights[r] == 0) continue;
      const double weight = step * weights[r];
      for (std::size_t i = 0; i < stage_.size(); ++i) stage_[i] += weight * changes_[r][i];
    }
    find_inputs(state, step, s);
    if (s < stages && !evaluate(state, s, stage_, changes_[s])) return fail(Reason::DeadPoint);
  }
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(stage_.begin(), stage_.end(), is_finite)) return fail(Reason::NotFinite);
  normalise(stage_);
  if (!strike(state, stages, stage_)) return fail(Reason::DeadPoint);
  const double work = stage_[work_], dissipated = stage_[work_ + 1];
  if (!evaluate(state, stages, stage_, last_change_)) return fail(Reason::DeadPoint);
  if (dependent_.any() && dependent_.largest_opening(bodies_) > kOpenLoop) return fail(Reason::OpenLoop);
  state.work += work;
  state.dissipated += dissipated;
  write(state, step);
  return Reason::None;
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
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[model_.actuators[i].coordinate];
    state.actuators[i].angle = released_[coordinate.joint].displacement[coordinate.component];
    double& rate = state.actuators[i].rate =
        stage_[rates_ + joints_[coordinate.joint].first_rate + coordinate.component];
    motors_.accept(i, step, rate, stage_[integrals_ + i], state.actuators[i].servo);
  }
  state.history.clear();
  state.time = last_time_ = state.time + step;
  std::copy(state.commands.begin(), state.commands.end(), last_commands_.begin());
  last_nodes_ = state.nodes;
  last_values_ = values_;
  motors_.keep_inputs();
}

}  // namespace flexarm
