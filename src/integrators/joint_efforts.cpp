#include "integrators/joint_efforts.h"

#include <cassert>
#include <cmath>

namespace flexarm {

JointEfforts::JointEfforts(const StepConfiguration& configuration, const StepHistories& histories)
    : configuration_(configuration),
      histories_(histories),
      efforts_(configuration.model().coordinates.size()),
      motor_ways_(configuration.model().actuators.size(), 0.0) {}

double JointEfforts::mean_of_ends(std::size_t coordinate, double at_end) const {
  if (configuration_.scheme().is_incremental()) return at_end;
  return 0.5 * (at_end + configuration_.state().efforts[coordinate]);
}

void JointEfforts::begin() {
  const Model& model = configuration_.model();
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const double commanded = configuration_.state().commands[i];
    efforts_[i] = histories_.effort(model, i, commanded);
    const bool has_history = model.coordinates[i].effort >= 0 && std::isnan(commanded);
    if (!has_history) efforts_[i].mean = mean_of_ends(i, efforts_[i].acting);
  }
}

void JointEfforts::set_motor(std::size_t coordinate, double acting, double at_end, double way) {
  assert(has_motor(configuration_.model().coordinates[coordinate]));
  motor_ways_[configuration_.model().coordinates[coordinate].actuator] = way;
  // The mean of the efforts at both ends, plus the part of `acting` that corrects it to the mean over the step.
  const double mean = configuration_.scheme().is_incremental()
                          ? acting
                          : acting + 0.5 * (configuration_.state().efforts[coordinate] - at_end);
  efforts_[coordinate] = {acting, mean, at_end};
}

void JointEfforts::find_drives(const ReducedResidual& residual, HeldEfforts& held, StepMeans& drives) {
  const Model& model = configuration_.model();
  const double weight = configuration_.effort_weight();
  for (const HeldJoint& joint : model.held) efforts_[joint.coordinate].acting = held.effort(joint, residual);
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const Coordinate& coordinate = model.coordinates[i];
    if (coordinate.motion < 0) continue;
    // The residual in the row of a prescribed coordinate is the effort that drives it. A held coordinate has no such
    // row.
    const int variable = configuration_.degrees_of_freedom().variable_of_joint(coordinate.joint);
    const double effort = efforts_[i].acting + residual.at(variable)[coordinate.component] / weight;
    efforts_[i] = {effort, mean_of_ends(i, effort), effort};
    drives.impulse[i] += configuration_.step() * (configuration_.forces_are_means() ? effort : efforts_[i].mean);
  }
}

void JointEfforts::add_work(double& work) const {
  const Model& model = configuration_.model();
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const ReleasedVector change = configuration_.increment_of(static_cast<int>(j));
    for (int k = 0; k < change.size(); ++k) {
      const std::size_t i = model.first_coordinate[j] + k;
      const Coordinate& coordinate = model.coordinates[i];
      work += efforts_[i].mean * (has_motor(coordinate) ? motor_ways_[coordinate.actuator] : change[k]);
    }
  }
}

void JointEfforts::accept(State& state) const {
  for (std::size_t i = 0; i < efforts_.size(); ++i) state.efforts[i] = efforts_[i].at_end;
}

}  // namespace flexarm
