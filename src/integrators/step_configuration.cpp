#include "integrators/step_configuration.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "joints/kinematics.h"
#include "math/cayley.h"
#include "math/pi.h"
#include "math/so3.h"
#include "math/step_end.h"

namespace flexarm {
namespace {

/// A slider that leaves its line at the end of the step may go this far beyond it, relative to the last element's
/// length.
constexpr double kLargestWayBeyond = 1.0;

}  // namespace

StepConfiguration::StepConfiguration(const Model& model, const Scheme& scheme, const DegreesOfFreedom& dof)
    : model_(model),
      scheme_(scheme),
      dof_(dof),
      free_nodes_(dof),
      guess_(dof.unknowns),
      begin_(model.nodes),
      end_(model.nodes),
      released_(model.initial_released),
      increments_(model.nodes.size(), Vector3::Zero()),
      keeps_begin_rates_(!scheme.is_incremental() && !scheme.is_static),
      begin_velocities_(model.nodes.size()),
      begin_rates_(model.joints.size()) {
  if (!has_incremental_joints() || model.slide_lines.empty()) return;
  begin_places_.resize(model.joints.size());
  end_places_.resize(model.joints.size());
}

void StepConfiguration::begin(const State& state, double step) {
  state_ = &state;
  step_ = step;
  end_time_ = step_end(state.time, step);
  const bool shifts_reactions = scheme_.hht != HhtForm::None && !scheme_.is_static && !state.study.reactions.empty();
  effort_weight_ = shifts_reactions ? 1 / (1 - scheme_.alpha) : 1;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) begin_[i] = node_pose(state.nodes[i]);
  std::copy(begin_.begin(), begin_.end(), end_.begin());
  std::copy(state.released.begin(), state.released.end(), released_.begin());
  if (keeps_begin_rates_) find_begin_rates();
  for (std::size_t j = 0; j < begin_places_.size(); ++j)
    if (const JointMap& joint = model_.joints[j]; joint.kind == JointMapKind::Slide)
      begin_places_[j] = slide_place(model_.slide_lines[joint.line], begin_, state.released[j].displacement[0]);
}

void StepConfiguration::find_begin_rates() {
  for (std::size_t i = 0; i < begin_velocities_.size(); ++i) begin_velocities_[i] = spatial_velocity(state_->nodes[i]);
  for (std::size_t j = 0; j < model_.joints.size(); ++j)
    begin_rates_[j] = released_rates(model_, static_cast<int>(j), begin_, state_->released[j], begin_velocities_);
}

void StepConfiguration::set_prescribed(double time) {
  for (std::size_t c = 0; c < model_.coordinates.size(); ++c) {
    const Coordinate& coordinate = model_.coordinates[c];
    if (coordinate.motion < 0) continue;
    const bool is_led = led_to_ && !std::isnan((*led_to_)[c]);
    released_[coordinate.joint].displacement[coordinate.component] =
        is_led ? (*led_to_)[c] : model_.histories[coordinate.motion](time);
  }
}

/// Guesses that velocities of nodes stay constant. Joint coordinates are guessed to stay where they are.
void StepConfiguration::guess_from_velocities() {
  guess_.setZero();
  for (int i = 0; i < dof_.node_count; ++i) {
    if (dof_.slave_joint[i] >= 0) continue;
    const NodeState& node = state_->nodes[i];
    guess_.segment<6>(dof_.equation[dof_.first[i]]) << step_ * node.velocity,
        step_ * (begin_[i].rotation * node.angular_velocity);
  }
}

void StepConfiguration::guess_from(const IncrementHistory& history, int order) {
  IncrementHistory::Weights weights = history.weights(order, 0, step_);
  if (weights[0] == 0) weights = history.weights(0, 0, step_);
  guess_.setZero();
  for (int i = 0; i <= order && weights[i] != 0; ++i)
    guess_ += weights[i] * Eigen::Map<const Eigen::VectorXd>(history.increments[i].data(), guess_.size());
}

void StepConfiguration::extrapolate(const IncrementHistory& history, int order) {
  if (history.holds_for(dof_.unknowns))
    guess_from(history, order);
  else
    guess_from_velocities();
  free_nodes_.advance(begin_, guess_, end_);
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    const int variable = dof_.variable_of_joint(static_cast<int>(j)), count = released_count(joint.kind);
    const auto entry = [&](int k) {
      const int equation = dof_.equation[dof_.first[variable] + k];
      return equation >= 0 ? guess_[equation] : 0.0;
    };
    if (joint.kind == JointMapKind::Scalar || joint.kind == JointMapKind::Slide) {
      released_[j].displacement[0] += entry(0);
    } else if (count > 0) {
      Vector3 rotation;
      for (int k = 0; k < 3; ++k) {
        if (count == 6) released_[j].displacement[k] += entry(k);
        rotation[k] = entry(count - 3 + k);
      }
      released_[j].rotation = (cayley::quaternion(rotation) * released_[j].rotation).normalized();
    }
  }
}

void StepConfiguration::update(const Eigen::VectorXd& increment) {
  assert(increment.size() == dof_.unknowns);
  free_nodes_.update(increment, end_);
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const int variable = dof_.variable_of_joint(static_cast<int>(j));
    ReleasedVector part(dof_.size[variable]);
    for (int k = 0; k < part.size(); ++k) {
      const int equation = dof_.equation[dof_.first[variable] + k];
      part[k] = equation >= 0 ? increment[equation] : 0.0;
    }
    released_[j] = updated(model_.joints[j], released_[j], part);
  }
}

void StepConfiguration::set_slaves() {
  place_followers(model_, released_);
  off_line_joint_ = -1;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    const bool slides = joint.kind == JointMapKind::Slide;
    if (slides && has_incremental_joints()) {
      end_places_[j] = slide_place(model_.slide_lines[joint.line], end_, released_[j].displacement[0]);
      end_[joint.slave] = slide_pose(slide_travel(static_cast<int>(j)), begin_[joint.slave].position);
    } else {
      end_[joint.slave] = slave_pose(model_, static_cast<int>(j), end_, released_[j]);
    }
    // The sign of a quaternion matters: it tells how far an element is bent (LocalRotations).
    Quaternion& orientation = end_[joint.slave].orientation;
    orientation = so3::nearer_of_two(orientation, begin_[joint.slave].orientation);
    if (slides && off_line_joint_ < 0 && !is_on_line(joint, static_cast<int>(j))) off_line_joint_ = static_cast<int>(j);
  }
  if (scheme_.is_static) return;
  set_increments(begin_, end_, increments_);
}

void StepConfiguration::set_end(const State& state) {
  assert(state.nodes.size() == end_.size() && state.released.size() == released_.size());
  for (std::size_t i = 0; i < state.nodes.size(); ++i) end_[i] = node_pose(state.nodes[i]);
  std::copy(state.released.begin(), state.released.end(), released_.begin());
  set_increments(begin_, end_, increments_);
}

void StepConfiguration::remember_increments(IncrementHistory& history) const {
  std::vector<double>& made = history.push(step_, dof_.unknowns);
  for (int i = 0; i < dof_.node_count; ++i) {
    const int equation = dof_.equation[dof_.first[i]];
    for (int k = 0; k < 3 && equation >= 0; ++k) {
      made[equation + k] = end_[i].position[k] - begin_[i].position[k];
      made[equation + 3 + k] = increments_[i][k];
    }
  }
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const ReleasedVector change = increment_of(static_cast<int>(j));
    const int first = dof_.first[dof_.variable_of_joint(static_cast<int>(j))];
    for (int k = 0; k < change.size(); ++k)
      if (dof_.equation[first + k] >= 0) made[dof_.equation[first + k]] = change[k];
  }
}

// ---------------------------------------------------------------- joints

double StepConfiguration::largest_overshoot(const JointMap& joint) const {
  return joint.leaving < 0 ? SlideLine::kLargestOvershoot : kLargestWayBeyond;
}

bool StepConfiguration::is_on_line(const JointMap& joint, int j) const {
  const SlideLine& line = model_.slide_lines[joint.line];
  const double to = released_[j].displacement[0];
  const int pieces = std::abs(line.piece_at(to) - line.piece_at(state_->released[j].displacement[0])) + 1;
  return line.overshoot(to) <= largest_overshoot(joint) && pieces <= SlideLine::kMostPieces;
}

double StepConfiguration::largest_way_beyond() const {
  double largest = 0;
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.leaving < 0) continue;
    largest = std::max(largest, model_.slide_lines[joint.line].overshoot(released_[j].displacement[0]));
  }
  return largest;
}

void StepConfiguration::note_events(FirstEvent& first) const {
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointMap& joint = model_.joints[j];
    if (joint.leaving < 0) continue;
    const SlideLine& line = model_.slide_lines[joint.line];
    const double from = state_->released[j].displacement[0], to = released_[j].displacement[0];
    const double start = to - from;  // assumes a constant rate
    if (from >= line.begin()) first.note(crossing(from, to, line.begin(), start));
    if (from <= line.end()) first.note(crossing(-from, -to, -line.end(), -start));
  }
}

bool StepConfiguration::is_driven_off_line() const {
  if (off_line_joint_ < 0) return false;
  const JointMap& joint = model_.joints[off_line_joint_];
  const Coordinate& travel = model_.coordinates[model_.first_coordinate[off_line_joint_]];
  const Coordinate& driven = travel.mimicked >= 0 ? model_.coordinates[travel.mimicked] : travel;
  const double to = released_[off_line_joint_].displacement[0];
  return driven.motion >= 0 && model_.slide_lines[joint.line].overshoot(to) > largest_overshoot(joint);
}

SlideTravel StepConfiguration::slide_travel(int j) const {
  assert(model_.joints[j].kind == JointMapKind::Slide);
  const JointMap& joint = model_.joints[j];
  return {model_.slide_lines[joint.line],
          begin_,
          end_,
          state_->released[j].displacement[0],
          released_[j].displacement[0],
          scheme_.heeds_slide_schemes ? joint.algorithm : SlideAlgorithm(),
          scheme_.arm_weight(),
          begin_places_.empty() ? nullptr : &begin_places_[j],
          end_places_.empty() ? nullptr : &end_places_[j]};
}

void StepConfiguration::joint_maps(int j, const Vector6& g, FoldMaps& maps, bool with_tangent) const {
  const JointMap& joint = model_.joints[j];
  const JointPose end = joint_pose(joint, end_, released_[j]);
  if (has_incremental_joints())
    incremental_maps(joint, joint_pose(joint, begin_, state_->released[j]), end, g, maps, with_tangent,
                     scheme_.arm_weight());
  else
    variational_maps(joint, end, g, maps);
}

void StepConfiguration::joint_maps(int j, const Vector6& g, SlideMaps& maps, bool with_tangent) const {
  const SlideTravel travel = slide_travel(j);
  if (has_incremental_joints())
    slide_incremental_maps(travel, g, maps, with_tangent);
  else
    slide_variational_maps(travel.line, end_, travel.to, g, maps, with_tangent);
}

MimicMap StepConfiguration::mimic_map(int coordinate) const {
  assert(model_.coordinates[coordinate].mimicked >= 0);
  const Coordinate& following = model_.coordinates[coordinate];
  const int joint = model_.coordinates[following.mimicked].joint;
  const double from = state_->released[joint].displacement[0], to = released_[joint].displacement[0];
  const MimicLaw& law = following.mimic;
  const double right = law.derivative(to);
  if (!has_incremental_joints()) return {right, right, law.second_derivative(to)};
  return {law.secant(from, to), right, law.secant_derivative(from, to)};
}

ReleasedVector StepConfiguration::increment_of(int joint) const {
  return released_increment(model_.joints[joint], state_->released[joint], released_[joint]);
}

double StepConfiguration::end_rate(const Coordinate& coordinate) const {
  assert(step_ != 0 && "nothing has a rate in statics");
  const double gamma = scheme_.rate_gamma();
  const double begin = begin_rates_[coordinate.joint][coordinate.component];
  return (increment_of(coordinate) / step_ - (1 - gamma) * begin) / gamma;
}

double StepConfiguration::increment_of(const Coordinate& coordinate) const {
  return increment_of(coordinate.joint)[coordinate.component];
}

StepConfiguration::LargestIncrement StepConfiguration::largest_increment() const {
  LargestIncrement largest;
  for (std::size_t i = 0; i < increments_.size(); ++i)
    if (const double square = increments_[i].squaredNorm(); square > largest.size)
      largest = {square, static_cast<int>(i)};
  largest.size = std::sqrt(largest.size);
  return largest;
}

double StepConfiguration::turn_of(const Coordinate& coordinate) const {
  const int j = coordinate.joint, k = coordinate.component % 3;
  const double change = released_[j].displacement[k] - state_->released[j].displacement[k];
  return model_.joints[j].rotation.norm() * std::abs(change);
}

int StepConfiguration::aliased_coordinate() const {
  for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
    const Coordinate& coordinate = model_.coordinates[i];
    if (!coordinate.is_angle && turn_of(coordinate) > kPi) return static_cast<int>(i);
  }
  return -1;
}

CoordinateStep StepConfiguration::coordinate_step(std::size_t index, double increment) const {
  assert(index < model_.coordinates.size());
  const Coordinate& coordinate = model_.coordinates[index];
  const int j = coordinate.joint, k = coordinate.component;
  CoordinateStep step;
  step.begin = state_->released[j].displacement[k % 3];
  step.end = released_[j].displacement[k % 3];
  step.increment = increment;
  step.step = step_;
  step.at_end = !scheme_.is_incremental();
  if (modes_) step.below = modes_->stops[index][0], step.above = modes_->stops[index][1];
  if (!step.at_end) return step;
  step.gamma = scheme_.gamma;
  step.begin_rate = keeps_begin_rates_ ? begin_rates_[j][k] : 0.0;
  step.blur = scheme_.blur;
  return step;
}

}  // namespace flexarm
