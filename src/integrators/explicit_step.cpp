#include "integrators/explicit_step.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "elements/load.h"
#include "flexarm/model/model_error.h"
#include "integrators/step_histories.h"
#include "joints/joint_forces.h"
#include "joints/joint_kinematics.h"
#include "math/so3.h"
#include "schemes/explicit_tableau.h"

namespace flexarm {
namespace {

/// Returns what explicit schemes cannot simulate in a model, in words; null: nothing.
const char* obstacle(const Model& model) {
  bool has_beams = false;
  for_each_element(model.beams, [&](const auto&) { has_beams = true; });
  if (has_beams) return "flexible links";
  if (!model.slide_lines.empty()) return "sliders";
  if (!model.closures.empty()) return "closed loops";
  if (!model.force_elements.empty()) return "springs, lines or contacts between points, or drag";
  if (!model.held.empty()) return "joints that a motion holds";
  for (const Coordinate& coordinate : model.coordinates) {
    if (coordinate.motion >= 0) return "prescribed motions";
    if (coordinate.mimicked >= 0) return "coordinates that follow others";
    if (coordinate.sticks && coordinate.friction > 0) return "dry friction";
    if (coordinate.friction_coefficient > 0) return "friction that depends on the load";
  }
  for (const Actuator& actuator : model.actuators) {
    if (actuator.servo) return "servos";
    if (actuator.drive.gear || actuator.gyroscope) return "rotors with a motion of their own";
    if (actuator.drive.loss > 0) return "losses of gears";
    if (std::isfinite(actuator.drive.effort_limit) || std::isfinite(actuator.drive.velocity_limit))
      return "motors with limits";
    if (actuator.spring && actuator.spring->elasticity.backlash > 0) return "play";
  }
  if (!model.reactions.empty()) return "sensors of reactions";
  return nullptr;
}

/// @throws ModelError naming what explicit schemes cannot simulate, if the model has some of it
const Model& suitable(const Model& model, const Scheme& scheme) {
  if (const char* what = obstacle(model))
    throw ModelError(fmt::format(
        "<integrator>: scheme '{}' has no {}; take one of the energy-momentum family, such as em", scheme.name, what));
  return model;
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
      poses_(model.nodes.size()),
      velocities_(model.nodes.size()),
      released_(model.joints.size()),
      applied_(model.coordinates.size()) {
  for (const JointMap& joint : model.joints) {
    joints_.push_back({static_cast<int>(rates_), bodies_.first_rate(static_cast<int>(joints_.size())), joint.kind});
    rates_ += position_count(joint.kind);
  }
  work_ = rates_ + bodies_.rate_count();
  efforts_.resize(bodies_.rate_count());
  armatures_.resize(bodies_.rate_count());
  for (const Coordinate& coordinate : model.coordinates) {
    armatures_[joints_[coordinate.joint].first_rate + coordinate.component] = armature(model, coordinate);
    penalties_.push_back(stop_penalty(coordinate, scheme.contact_time));
  }
  for (std::vector<double>* numbers : {&begin_, &stage_, &last_change_}) numbers->resize(work_ + 2);
  changes_.assign(tableau_.weights.size(), std::vector<double>(work_ + 2));
  last_commands_.resize(model.coordinates.size());
}

// ---------------------------------------------------------------- numbers and state

void ExplicitStep::pack(const State& state) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = node_pose(state.nodes[i]);
    velocities_[i] = spatial_velocity(state.nodes[i]);
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Released& released = state.released[j];
    double* to = begin_.data() + joints_[j].first_position;
    if (joints_[j].kind == JointMapKind::Scalar) *to++ = released.displacement[0];
    if (joints_[j].kind == JointMapKind::Free) to = std::copy_n(released.displacement.data(), 3, to);
    if (position_count(joints_[j].kind) >= 4) std::copy_n(released.rotation.coeffs().data(), 4, to);
    const ReleasedVector rates = released_rates(model_, static_cast<int>(j), poses_, released, velocities_);
    std::copy_n(rates.data(), released_count(joints_[j].kind), begin_.data() + rates_ + joints_[j].first_rate);
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
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  return state.time == last_time_ && state.wrenches.empty() &&
         std::equal(state.commands.begin(), state.commands.end(), last_commands_.begin(), same);
}

// ---------------------------------------------------------------- derivatives

void ExplicitStep::evaluate(const State& state, double time, const std::vector<double>& numbers,
                            std::vector<double>& change) {
  unpack(numbers);
  const double* rates = numbers.data() + rates_;
  bodies_.set(released_, rates);
  change[work_] = change[work_ + 1] = 0;
  add_loads(state, time, change);
  find_efforts(state, time, rates, change);
  bodies_.accelerate(efforts_.data(), armatures_.data(), change.data() + rates_);
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
}

/// Sets the efforts on all rates. Adds their work and what they dissipate to `change`.
void ExplicitStep::find_efforts(const State& state, double time, const double* rates, std::vector<double>& change) {
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[i];
    const int at = joints_[coordinate.joint].first_rate + coordinate.component;
    const double rate = rates[at];
    const double of_scene = coordinate.effort < 0 ? 0 : model_.histories[coordinate.effort](time);
    applied_[i] = applied_effort(coordinate, state.commands[i], of_scene);
    double& effort = efforts_[at] = applied_[i];
    change[work_] += applied_[i] * rate;
    const double position = coordinate.is_angle ? 0 : released_[coordinate.joint].displacement[coordinate.component];
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

void ExplicitStep::add_loads(const State& state, double time, std::vector<double>& change) {
  for (const NodalLoad& load : model_.loads) add_load(load, model_.histories[load.history](time), change);
  for (const NodalLoad& load : state.wrenches) add_load(load, 1, change);
}

void ExplicitStep::add_load(const NodalLoad& load, double scale, std::vector<double>& change) {
  const Matrix3& rotation = bodies_.rotation(load.node);
  const Vector6 wrench = load_action(load, scale, rotation, rotation, LoadPoint::End).wrench;
  bodies_.add_force(load.node, wrench);
  change[work_] += wrench.dot(bodies_.velocity(load.node));
}

// ---------------------------------------------------------------- the step

bool ExplicitStep::advance(State& state, double step, bool reuses) {
  const bool goes_on = reuses && is_as_left(state);
  if (goes_on)
    begin_ = stage_;
  else
    pack(state);
  begin_[work_] = begin_[work_ + 1] = 0;
  const std::size_t stages = changes_.size();
  if (goes_on && acts_as_before(state))
    changes_[0] = last_change_;
  else
    evaluate(state, state.time, begin_, changes_[0]);
  for (std::size_t s = 1; s <= stages; ++s) {
    const std::vector<double>& weights = s < stages ? tableau_.stages[s] : tableau_.weights;
    stage_ = begin_;
    for (std::size_t r = 0; r < weights.size(); ++r) {
      if (weights[r] == 0) continue;
      const double weight = step * weights[r];
      for (std::size_t i = 0; i < stage_.size(); ++i) stage_[i] += weight * changes_[r][i];
    }
    if (s < stages) evaluate(state, state.time + tableau_.times[s] * step, stage_, changes_[s]);
  }
  if (!std::all_of(stage_.begin(), stage_.end(), [](double number) { return std::isfinite(number); })) {
    last_nodes_.clear();  // what was known at the end of the last step is lost
    return false;
  }
  normalise(stage_);
  const double work = stage_[work_], dissipated = stage_[work_ + 1];
  evaluate(state, state.time + step, stage_, last_change_);
  state.work += work;
  state.dissipated += dissipated;
  write(state, state.time + step);
  return true;
}

void ExplicitStep::write(State& state, double time) {
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
    state.actuators[i].rate = stage_[rates_ + joints_[coordinate.joint].first_rate + coordinate.component];
  }
  state.history.clear();
  state.time = last_time_ = time;
  std::copy(state.commands.begin(), state.commands.end(), last_commands_.begin());
  last_nodes_ = state.nodes;
}

}  // namespace flexarm
