#include "simulation/published_motion.h"

#include <algorithm>
#include <cmath>

#include "elements/node_motion.h"
#include "joints/kinematics.h"
#include "math/cayley.h"
#include "math/pi.h"
#include "simulation/observables.h"

namespace flexarm {

// ---------------------------------------------------------------- how well two successive changes agree

// With these criteria, values that are extrapolated for output do not overshoot or ring.

namespace {

/// Whether the changes differ by at most a third of their sum. Then one is at most twice the other.
template <class Change>
bool belong_to_smooth_motion(const Change& last, const Change& before) {
  return (last - before).norm() <= 1.0 / 3 * (last + before).norm();
}

/// The part of the last change that is also in the change before it. Zero if they have opposite signs.
template <class Change>
Change agreed_part(const Change& last, const Change& before) {
  const double agreement = last.dot(before);
  return agreement > 0 ? Change(std::min(agreement / last.squaredNorm(), 1.0) * last) : Change(Change::Zero());
}

}  // namespace

// ---------------------------------------------------------------- velocities

namespace {

/// Larger turns are not converted to tangent-scaled increments, which tend to infinity at a turn of pi [rad].
constexpr double kLargestTurn = 0.5 * kPi;

/// The increment of a scalar coordinate, tangent-scaled if the rule for angular velocities is. Increments of prescribed
/// motions are not converted: the motion's function gives the velocity.
double counted_increment(const TimeRule& rule, const JointMap& joint, const Coordinate& coordinate, double increment) {
  const double rotation = joint.kind == JointMapKind::Scalar ? joint.rotation.norm() : 0, turn = rotation * increment;
  const bool counts = rule.body_rotation == RotationRule::TangentScaled && coordinate.motion < 0 && rotation > 0 &&
                      std::abs(turn) < kLargestTurn;
  return counts ? 2 * std::tan(0.5 * turn) / rotation : increment;
}

}  // namespace

template <int Size>
Eigen::Matrix<double, Size, 1> LastSteps::rate_at_end(const MeanRates<Size>& mean) const {
  using Rate = Eigen::Matrix<double, Size, 1>;
  const auto& h = length;
  // Divided differences, whose values are half the rate's slope and a sixth of its curvature.
  const auto slope = [&](int k) { return Rate((mean[k] - mean[k + 1]) / (h[k] + h[k + 1])); };
  const auto curvature = [&](int k) { return Rate((slope(k) - slope(k + 1)) / (h[k] + h[k + 1] + h[k + 2])); };
  const Rate last = slope(0);
  if (count < 3) return mean[0] + h[0] * last;
  const Rate before = slope(1), earlier = count < 4 ? before : slope(2);
  const bool have_slopes = belong_to_smooth_motion(last, before) && belong_to_smooth_motion(before, earlier);
  const auto have_curvatures = [&] {
    const Rate middle = curvature(1);
    return belong_to_smooth_motion(curvature(0), middle) && belong_to_smooth_motion(middle, curvature(2));
  };
  if (have_slopes || (count >= 5 && have_curvatures())) return mean[0] + h[0] * (last + (h[0] + h[1]) * curvature(0));
  return mean[0];
}
template Eigen::Matrix<double, 1, 1> LastSteps::rate_at_end<1>(const MeanRates<1>&) const;
template Eigen::Matrix<double, 3, 1> LastSteps::rate_at_end<3>(const MeanRates<3>&) const;

void OutputVelocities::update_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule,
                                    const State& state) {
  poses_.resize(state.nodes.size());
  nodes_.resize(state.nodes.size());
  rates_.assign(model.joints.size_with_held(), ReleasedVector::Zero(1));  // the rates of held joints stay zero
  const IncrementHistory& history = state.history;
  has_steps_ = history.holds_for(dof.unknowns) && history.count >= 2;
  if (has_steps_) {
    steps_.count = std::min(history.count, LastSteps::kMost);
    std::copy_n(history.steps.begin(), LastSteps::kMost, steps_.length.begin());
    return set_rates(model, dof, rule, state);
  }
  set_poses(state);
  set_scheme_velocities(state);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    rates_[j] = released_rates(model, static_cast<int>(j), poses_, state.released[j], nodes_);
}

void OutputVelocities::update_nodes(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule,
                                    const State& state) {
  if (!has_steps_) return;  // update_rates() has already set the scheme's own velocities
  set_poses(state);
  set_free_nodes(dof, rule, state);
  set_slaves(model, state);
}

void OutputVelocities::set_poses(const State& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) poses_[i] = node_pose(state.nodes[i]);
}

void OutputVelocities::set_scheme_velocities(const State& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) nodes_[i] = spatial_velocity(state.nodes[i]);
}

void OutputVelocities::set_free_nodes(const DegreesOfFreedom& dof, const TimeRule& rule, const State& state) {
  for (int i = 0; i < dof.node_count; ++i) {
    if (dof.slave_joint[i] >= 0) continue;
    LastSteps::MeanRates<3> velocity, spin;
    for (int k = 0; k < steps_.count; ++k) {
      const double* increment = state.history.increments[k].data() + dof.equation[dof.first[i]];
      velocity[k] = Vector3(increment[0], increment[1], increment[2]) / steps_.length[k];
      spin[k] = counted_rotation(rule, Vector3(increment[3], increment[4], increment[5])) / steps_.length[k];
    }
    nodes_[i] << steps_.rate_at_end<3>(velocity), steps_.rate_at_end<3>(spin);
  }
}

void OutputVelocities::set_rates(const Model& model, const DegreesOfFreedom& dof, const TimeRule& rule,
                                 const State& state) {
  // The increment of a coordinate in a step that ended at `end`. A prescribed coordinate is no unknown: its motion
  // gives the increment.
  const auto increment = [&](const Coordinate& coordinate, int k, double end) {
    const int equation = dof.equation[dof.scalar_of(coordinate)];
    if (equation >= 0) return state.history.increments[k][equation];
    if (coordinate.motion < 0) return 0.0;
    const TimeFunction& motion = model.histories[coordinate.motion];
    return motion(end) - motion(end - steps_.length[k]);
  };
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    const Coordinate* coordinates = model.coordinates.data() + model.first_coordinate[j];
    ReleasedVector& rates = rates_[j];
    rates.resize(released_count(joint.kind));
    LastSteps::MeanRates<1> scalar;
    std::array<LastSteps::MeanRates<3>, 2> vectors;  // a translation, a rotation, or both
    double end = state.time;
    for (int k = 0; k < steps_.count; ++k) {
      const double length = steps_.length[k];
      if (rates.size() == 1)
        scalar[k][0] = counted_increment(rule, joint, coordinates[0], increment(coordinates[0], k, end)) / length;
      for (int c = 0; c + 3 <= rates.size(); c += 3) {
        Vector3& mean = vectors[c / 3][k];
        for (int i = 0; i < 3; ++i) mean[i] = increment(coordinates[c + i], k, end);
        mean = (coordinates[c].is_angle ? counted_rotation(rule, mean) : mean) / length;
      }
      end -= length;
    }
    if (rates.size() == 1) rates = steps_.rate_at_end<1>(scalar);
    for (int c = 0; c + 3 <= rates.size(); c += 3) rates.segment<3>(c) = steps_.rate_at_end<3>(vectors[c / 3]);
  }
  set_follower_rates(model, state.released, rates_);
}

void OutputVelocities::set_slaves(const Model& model, const State& state) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    nodes_[model.joints[j].slave] =
        slave_velocity(model, static_cast<int>(j), poses_, state.released[j], nodes_).with(rates_[j]);
  }
}

// ---------------------------------------------------------------- accelerations of points

namespace {

/// The acceleration of a point of a rigid link, from that of its node, which explicit schemes know.
ProbeAcceleration acceleration_by_node(const State& state, const ProbePoint& point) {
  if (point.attachment.node < 0) return {};
  const NodeState& node = state.nodes[point.attachment.node];
  const Vector3 arm = node.orientation * point.attachment.offset.position;
  const Vector3 spin = node.orientation * node.angular_velocity, change = node.orientation * node.angular_acceleration;
  return {node.acceleration + change.cross(arm) + spin.cross(spin.cross(arm)), change};
}

/// How a quantity goes on changing, from its last two rates of change: their mean if the motion is smooth, else the
/// part in which they agree.
Vector3 agreed(const Vector3& last, const Vector3& before) {
  return belong_to_smooth_motion(last, before) ? Vector3(0.5 * (last + before)) : agreed_part(last, before);
}

Vector3 increment(const State& state, int step, int equation) {
  return equation < 0 ? Vector3(Vector3::Zero())
                      : Vector3(Eigen::Map<const Vector3>(state.history.increments[step].data() + equation));
}

/// Undoes a rotation by a tangent-scaled increment.
Quaternion turned_back(const Quaternion& orientation, const Vector3& by) {
  return (cayley::quaternion(Vector3(-by)) * orientation).normalized();
}

}  // namespace

Vector3 MeanRates::change_at_end() const {
  if (count < 2) return Vector3::Zero();
  std::array<double, kMost> middle;  // of the steps; times relative to the end of the newest one
  double end = 0;
  for (int k = 0; k < count; ++k) {
    middle[k] = end - 0.5 * length[k];
    end -= length[k];
  }
  const auto slope = [&](int i, int k) { return Vector3((rate[i] - rate[k]) / (middle[i] - middle[k])); };
  if (count == 2) return slope(0, 1);
  // The mean slope over two steps, in which anything that alternates from step to step cancels.
  Vector3 mean = slope(0, 2);
  if (count == 3) return mean;
  const auto place = [&](int i) { return 0.5 * (middle[i] + middle[i + 1]); };
  const Vector3 last = (slope(0, 1) - slope(1, 2)) / (place(0) - place(1));
  const Vector3 before = (slope(1, 2) - slope(2, 3)) / (place(1) - place(2));
  return mean - 0.5 * (middle[0] + middle[2]) * agreed(last, before);
}

void PastMotion::update(const MotionView& view) {
  const State& state = view.state;
  const IncrementHistory& history = state.history;
  count_ = history.holds_for(view.dof.unknowns) ? std::min(history.count, MeanRates::kMost) : 0;
  earlier_.nodes = state.nodes;
  earlier_.released = state.released;
  poses_.resize(state.nodes.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = node_pose(state.nodes[i]);
  for (State& configuration : configurations_) configuration.nodes.resize(state.nodes.size());
  double time = state.time;
  for (int step = 0; step < count_; ++step) {
    length_[step] = history.steps[step];
    time -= length_[step];
    go_back(view, step, time);
    configurations_[step].nodes = earlier_.nodes;
  }
}

/// Goes back by one step, which began at time `begin` [s].
void PastMotion::go_back(const MotionView& view, int step, double begin) {
  const auto& [model, dof, rule, state] = view;
  for (int i = 0; i < dof.node_count; ++i) {
    if (dof.slave_joint[i] >= 0) continue;
    const int equation = dof.equation[dof.first[i]];
    earlier_.nodes[i].position -= increment(state, step, equation);
    earlier_.nodes[i].orientation = turned_back(earlier_.nodes[i].orientation, increment(state, step, equation + 3));
    poses_[i] = node_pose(earlier_.nodes[i]);
  }
  for (const Coordinate& coordinate : model.coordinates) {
    Released& released = earlier_.released[coordinate.joint];
    const int equation = dof.equation[dof.scalar_of(coordinate)];
    if (coordinate.is_angle) {
      if (coordinate.component % 3 == 0)  // all three at once
        released.rotation = turned_back(released.rotation, increment(state, step, equation));
    } else if (coordinate.motion >= 0) {
      released.displacement[coordinate.component] = model.histories[coordinate.motion](begin);
    } else if (equation >= 0) {
      released.displacement[coordinate.component] -= state.history.increments[step][equation];
    }
  }
  place_followers(model, earlier_.released);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int slave = model.joints[j].slave;
    poses_[slave] = slave_pose(model, static_cast<int>(j), poses_, earlier_.released[j]);
    NodeState& node = earlier_.nodes[slave];
    node.position = poses_[slave].position;
    // The sign of the quaternion matters: of two opposite quaternions, only one shows how far an element is bent
    // (LocalRotations).
    node.orientation = so3::nearer_of_two(poses_[slave].orientation, node.orientation);
    poses_[slave].orientation = node.orientation;
  }
}

ProbeAcceleration PastMotion::acceleration(const MotionView& view, const ProbePoint& point) const {
  if (view.rule.tableau) return acceleration_by_node(view.state, point);
  MeanRates velocity, spin;
  velocity.count = spin.count = count_;
  velocity.length = spin.length = length_;
  Pose end = probe_pose(view.model, view.state, point);
  for (int k = 0; k < count_; ++k) {
    const Pose begin = probe_pose(view.model, configurations_[k], point);
    velocity.rate[k] = (end.position - begin.position) / length_[k];
    spin.rate[k] = counted_rotation(view.rule, cayley::increment(begin.orientation, end.orientation)) / length_[k];
    end = begin;
  }
  return {velocity.change_at_end(), spin.change_at_end()};
}

}  // namespace flexarm
