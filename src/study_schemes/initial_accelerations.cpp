#include "study_schemes/initial_accelerations.h"

#include <algorithm>

#include "joints/joint_kinematics.h"

namespace flexarm {
namespace {

// A difference quotient over a step h has a truncation error of order h and a round-off error of order epsilon / h^2.
/// Length of the first step, relative to the steps to come.
constexpr double kFirst = 1e-2;
/// The same during a motion, where steps may be very short. The error of the velocity is h^2/8 times the jerk: of
/// second order, as that of the rule itself.
constexpr double kLater = 0.5;
/// The shortest of these [s]. In less time nothing happens, and the difference of velocities would be round-off.
constexpr double kShortest = 1e-8;
/// Tolerance of Newton's method during a motion: what it leaves is divided by the square of the step.
constexpr double kTolerance = 1e-12;

Scheme momentum_scheme() {
  Scheme scheme = *find_scheme("m1");
  scheme.heeds_slide_schemes = false;  // the slides' schemes were chosen for another scheme
  return scheme;
}

StepSettings short_step(StepSettings settings) {
  settings.step *= kFirst;
  settings.events = {};
  return settings;
}

}  // namespace

InitialAccelerations::InitialAccelerations(const Model& model, const StepSettings& of_step)
    : model_(model),
      first_step_(kFirst * of_step.step),
      momentum_(model, momentum_scheme(), short_step(of_step)),
      poses_(model.nodes.size()),
      velocities_(model.nodes.size()) {}

StepResult InitialAccelerations::find(State& state) {
  return find(state, first_step_);
}

void InitialAccelerations::renew(State& state, double step) {
  put_on_joints(state);
  const double length = std::max(kLater * step, kShortest);
  momentum_.set_step(length);
  momentum_.set_tolerance(kTolerance);
  find(state, length);
}

StepResult InitialAccelerations::find(State& state, double step) {
  moved_ = state;
  moved_.halving_level = 0;
  StepResult result = momentum_.advance(moved_);
  if (!result.converged) return result;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    state.nodes[i].acceleration = (moved_.nodes[i].velocity - state.nodes[i].velocity) / step;
    state.nodes[i].angular_acceleration = (moved_.nodes[i].angular_velocity - state.nodes[i].angular_velocity) / step;
  }
  for (std::size_t i = 0; i < state.study.mass_points.size(); ++i)
    state.study.mass_points[i].angular_acceleration =
        (moved_.study.mass_points[i].angular_velocity - state.study.mass_points[i].angular_velocity) / step;
  for (std::size_t i = 0; i < state.actuators.size(); ++i) {
    state.actuators[i].acceleration = (moved_.actuators[i].rate - state.actuators[i].rate) / step;
    // The work of the first step uses the motor's effort at both ends. The effort at the start is the one that caused
    // these accelerations.
    const int coordinate = model_.actuators[i].coordinate;
    if (model_.coordinates[coordinate].motion < 0) state.efforts[coordinate] = moved_.efforts[coordinate];
  }
  return result;
}

void InitialAccelerations::put_on_joints(State& state) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = node_pose(state.nodes[i]);
    velocities_[i] = spatial_velocity(state.nodes[i]);
  }
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const int index = static_cast<int>(j), slave = model_.joints[j].slave;
    const Released& released = state.released[j];
    const ReleasedVector rates = released_rates(model_, index, poses_, released, velocities_);
    velocities_[slave] = slave_velocity(model_, index, poses_, released, velocities_).with(rates);
    NodeState& node = state.nodes[slave];
    node.velocity = velocities_[slave].head<3>();
    node.angular_velocity = node.orientation.conjugate() * Vector3(velocities_[slave].tail<3>());
  }
}

}  // namespace flexarm
