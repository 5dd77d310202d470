// The trial configuration of a step: its start, its guess, Newton updates on the group.
#include <algorithm>

#include "integrators/step_system.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Way beyond the end of a line that a stop may let a slider penetrate, relative to the last element.
constexpr double kLargestOvershoot = 0.1;
/// The same of one that leaves the line, which happens at the end of the step.
constexpr double kLargestWayBeyond = 1.0;

}  // namespace

void StepSystem::load_begin_configuration(const State& state) {
  state_ = &state;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) begin_[i] = node_pose(state.nodes[i]);
  reference_.begin(state);
  std::copy(begin_.begin(), begin_.end(), end_.begin());
  std::copy(state.released.begin(), state.released.end(), released_.begin());
  for (ReleasedVector& multipliers : multipliers_) multipliers.setZero();
}

void StepSystem::compute_begin_points() {
  points_valid_ = true;
  conserving_beams_.set_begin(begin_);
  if (scheme_.stress == StressRule::Conjugate) return;
  for_each_element(model_.beams, [&](const auto& element) {
    using Element = std::decay_t<decltype(element)>;
    constexpr int N = Element::kNodes;
    std::array<Quaternion, N> orientation;
    std::array<Vector3, N> position;
    for (int i = 0; i < N; ++i) {
      orientation[i] = begin_[element.nodes[i]].orientation;
      position[i] = begin_[element.nodes[i]].position;
    }
    const LocalRotations<N> local(orientation);
    for (int k = 0; k < Element::kStiffnessPoints; ++k) {
      const auto& point = element.stiffness_points[k];
      const int index = element.first_stiffness_point + k;
      begin_points_[index] = point_kinematics(
          reference_.is_used() ? state_->stiffness_rotations[index] : local.evaluate(point.shape, point.derivative),
          interpolate<N>(point.derivative, position), point.reference_strain);
    }
    for (int k = 0; k < Element::kMassPoints; ++k) {
      const auto& point = element.mass_points[k];
      const int index = element.first_mass_point + k;
      begin_mass_rotations_[index] = reference_.is_used() ? state_->mass_rotations[index].rotation
                                                          : local.evaluate(point.shape, point.derivative).rotation;
    }
  });
}

void StepSystem::compute_begin_rates() {
  for (std::size_t i = 0; i < begin_velocities_.size(); ++i) begin_velocities_[i] = spatial_velocity(state_->nodes[i]);
  for (std::size_t j = 0; j < model_.joints.size(); ++j)
    begin_rates_[j] = released_rates(model_, static_cast<int>(j), begin_, released_[j], begin_velocities_);
}

void StepSystem::begin(const State& state, double step, Guess guess) {
  static_ = false;
  updates_ = 0;
  step_ = step;
  load_factor_ = 1;
  load_begin_configuration(state);
  if (!points_valid_) compute_begin_points();
  conserving_beams_.set_mid_functions(motion());
  for (std::size_t i = 0; i < model_.histories.size(); ++i) {
    history_values_[i] = model_.histories[i](state.time + load_time() * step);
    if (!scheme_.is_incremental()) begin_history_values_[i] = model_.histories[i](state.time);
  }
  if (!scheme_.is_incremental() || !carriers_.empty()) compute_begin_rates();
  begin_friction();
  if (guess != Guess::Unchanged) extrapolate(guess == Guess::Extrapolated ? state.history.order : 0);
  set_prescribed(state.time + step);
  set_slaves();
  update_increments();
}

void StepSystem::begin_static(const State& state, double load_factor) {
  static_ = true;
  step_ = 0;
  load_factor_ = load_factor;
  load_begin_configuration(state);
  if (reference_.is_used()) compute_begin_points();
  for (std::size_t i = 0; i < model_.histories.size(); ++i) history_values_[i] = model_.histories[i](0.0);
  set_prescribed(0.0);
  set_slaves();
}

void StepSystem::set_prescribed(double time) {
  for (const Coordinate& coordinate : model_.coordinates)
    if (coordinate.motion >= 0)
      released_[coordinate.joint].displacement[coordinate.component] = model_.histories[coordinate.motion](time);
}

void StepSystem::extrapolate(int order) {
  const State& state = *state_;
  const IncrementHistory& history = state.history;
  const bool has_last = history.holds_for(dof_.unknowns);
  IncrementHistory::Weights weights = history.weights(order, 0, step_);
  if (weights[0] == 0) weights = history.weights(0, 0, step_);
  const auto entry = [&](int variable, int k) {
    const int equation = dof_.equation[dof_.first[variable] + k];
    double sum = 0;
    for (int i = 0; i <= order && equation >= 0 && weights[i] != 0; ++i)
      sum += weights[i] * history.increments[i][equation];
    return sum;
  };
  for (int i = 0; i < dof_.node_count; ++i) {
    if (dof_.slave_joint[i] >= 0) continue;
    Vector3 displacement = step_ * state.nodes[i].velocity;
    Vector3 rotation = step_ * (begin_[i].rotation * state.nodes[i].angular_velocity);
    if (has_last)
      for (int k = 0; k < 3; ++k) displacement[k] = entry(i, k), rotation[k] = entry(i, 3 + k);
    end_[i].position += displacement;
    end_[i].orientation = (cayley::quaternion(rotation) * begin_[i].orientation).normalized();
    end_[i].rotation = end_[i].orientation.toRotationMatrix();
  }
  if (!has_last) return;  // the released coordinates of the first step start where they are
  extrapolate_multipliers();
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    const int variable = dof_.variable_of_joint(static_cast<int>(j)), count = released_count(joint.kind);
    if (joint.kind == JointMapKind::Scalar || joint.kind == JointMapKind::Slide) {
      released_[j].displacement[0] += entry(variable, 0);
    } else if (count > 0) {
      Vector3 rotation;
      for (int k = 0; k < 3; ++k) {
        if (count == 6) released_[j].displacement[k] += entry(variable, k);
        rotation[k] = entry(variable, count - 3 + k);
      }
      released_[j].rotation = (cayley::quaternion(rotation) * released_[j].rotation).normalized();
    }
  }
}

bool StepSystem::is_on_line(const JointMap& joint, int j) const {
  const SlideLine& line = model_.slide_lines[joint.line];
  const double to = released_[j].displacement[0];
  const int pieces = std::abs(line.piece_at(to) - line.piece_at(state_->released[j].displacement[0])) + 1;
  const double largest = joint.leaving < 0 ? kLargestOvershoot : kLargestWayBeyond;
  return line.overshoot(to) <= largest && pieces <= SlideLine::kMostPieces;
}

SlideTravel StepSystem::slide_travel(int j) const {
  const JointMap& joint = model_.joints[j];
  return {model_.slide_lines[joint.line],
          begin_,
          end_,
          state_->released[j].displacement[0],
          released_[j].displacement[0],
          joint.algorithm,
          scheme_.arm_weight()};
}

void StepSystem::set_slaves() {
  for (const Coordinate& coordinate : model_.coordinates)
    if (coordinate.mimicked >= 0) {
      const Coordinate& master = model_.coordinates[coordinate.mimicked];
      released_[coordinate.joint].displacement[coordinate.component] =
          coordinate.mimic.value(released_[master.joint].displacement[master.component]);
    }
  is_off_line_ = false;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.kind == JointMapKind::Slide && !static_ && scheme_.is_incremental())
      end_[joint.slave] = slide_pose(slide_travel(static_cast<int>(j)), begin_[joint.slave].position);
    else
      end_[joint.slave] = slave_pose(model_, static_cast<int>(j), end_, released_[j]);
    if (joint.kind == JointMapKind::Slide) is_off_line_ = is_off_line_ || !is_on_line(joint, static_cast<int>(j));
  }
}

void StepSystem::update_increments() {
  for (std::size_t i = 0; i < end_.size(); ++i) {
    increments_[i] = cayley::increment(begin_[i].orientation, end_[i].orientation);
  }
}

void StepSystem::update(const Eigen::VectorXd& increment) {
  remember_smooth_rates();
  for (int i = 0; i < dof_.node_count; ++i) {
    if (dof_.slave_joint[i] >= 0) continue;
    const int equation = dof_.equation[dof_.first[i]];
    end_[i].position += increment.segment<3>(equation);
    const Vector3 spin = increment.segment<3>(equation + 3);
    end_[i].orientation = (so3::exp_quaternion(spin) * end_[i].orientation).normalized();
    end_[i].rotation = end_[i].orientation.toRotationMatrix();
  }
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const int variable = dof_.variable_of_joint(static_cast<int>(j));
    ReleasedVector part(dof_.size[variable]);
    for (int k = 0; k < part.size(); ++k) {
      const int equation = dof_.equation[dof_.first[variable] + k];
      part[k] = equation >= 0 ? increment[equation] : 0.0;
    }
    released_[j] = updated(model_.joints[j], released_[j], part);
  }
  update_multipliers(increment);
  place_held_coordinates();
  stop_smooth_reversals();
  set_slaves();
  if (!static_) update_increments();
}

}  // namespace flexarm
