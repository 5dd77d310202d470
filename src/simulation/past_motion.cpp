#include "simulation/past_motion.h"

#include <algorithm>

#include "elements/nodal_inertia.h"
#include "joints/joint_kinematics.h"
#include "math/cayley.h"
#include "simulation/agreement.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// By which something goes on to change, as its last two rates of change have it: their mean, or the lesser of both as
/// far as they agree.
Vector3 agreed(const Vector3& last, const Vector3& before) {
  return belong_to_smooth_motion(last, before) ? Vector3(0.5 * (last + before)) : agreed_part(last, before);
}

Vector3 increment(const State& state, int step, int equation) {
  return equation < 0 ? Vector3(Vector3::Zero())
                      : Vector3(Eigen::Map<const Vector3>(state.history.increments[step].data() + equation));
}

/// Rotates back by a tangent-scaled increment.
Quaternion turned_back(const Quaternion& orientation, const Vector3& by) {
  return (cayley::quaternion(Vector3(-by)) * orientation).normalized();
}

}  // namespace

Vector3 MeanRates::change_at_end() const {
  if (count < 2) return Vector3::Zero();
  std::array<double, kMost> middle;  // of the steps, counted from the end
  double end = 0;
  for (int k = 0; k < count; ++k) {
    middle[k] = end - 0.5 * length[k];
    end -= length[k];
  }
  const auto slope = [&](int i, int k) { return Vector3((rate[i] - rate[k]) / (middle[i] - middle[k])); };
  if (count == 2) return slope(0, 1);
  // Means of two steps have lost what alternates.
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

/// Takes one step back, to time `begin` [s].
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
  // No entry's master is the slave of an earlier one.
  for (auto mimic = dof.mimics.rbegin(); mimic != dof.mimics.rend(); ++mimic) {
    const Coordinate& following = model.coordinates[mimic->coordinate];
    earlier_.released[following.joint].displacement[0] =
        following.mimic.value(earlier_.released[model.coordinates[following.mimicked].joint].displacement[0]);
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int slave = model.joints[j].slave;
    poses_[slave] = slave_pose(model, static_cast<int>(j), poses_, earlier_.released[j]);
    NodeState& node = earlier_.nodes[slave];
    node.position = poses_[slave].position;
    // Which of two opposite quaternions it is tells how far an element is bent (LocalRotations).
    node.orientation = so3::nearer_of_two(poses_[slave].orientation, node.orientation);
    poses_[slave].orientation = node.orientation;
  }
}

ProbeAcceleration PastMotion::acceleration(const MotionView& view, const ProbePoint& point) const {
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
