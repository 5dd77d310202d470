// Loops that multipliers close: their forces, and the multipliers' way through a step.
#include <algorithm>
#include <cmath>

#include "integrators/step_system.h"

namespace flexarm {

ClosurePoses StepSystem::closure_poses(const LoopClosure& closure, const std::vector<NodePose>& nodes) const {
  return {closure.parent < 0 ? NodePose() : nodes[closure.parent], nodes[closure.child]};
}

void StepSystem::add_closures(bool with_tangent) {
  // Multipliers are forces of the whole step: no scheme weights them.
  const double weight = !static_ && scheme_.is_incremental() ? 0.5 : 1.0;
  ClosureMaps maps;
  for (std::size_t k = 0; k < model_.closures.size(); ++k) {
    const LoopClosure& closure = model_.closures[k];
    const ClosurePoses begin = closure_poses(closure, begin_), end = closure_poses(closure, end_);
    for (std::size_t i = 0; i < closure.constraints.size(); ++i) {
      closure_maps(closure, closure.constraints[i], begin, end, weight, maps);
      const int closure_index = static_cast<int>(k), index = static_cast<int>(i);
      rows_.add_closure(closure_index, index, multipliers_[k][i], maps);
      if (with_tangent) backend_->add_closure(closure_index, index, multipliers_[k][i], maps);
    }
  }
}

double StepSystem::open_loop() const {
  double largest = 0;
  for (const LoopClosure& closure : model_.closures)
    for (const ClosureConstraint& constraint : closure.implied) {
      const double scale = constraint.kind == ClosureConstraint::Kind::Gap ? model_.length_scale : 1.0;
      largest = std::max(largest, std::abs(closure_value(closure, constraint, closure_poses(closure, end_))) / scale);
    }
  return largest;
}

void StepSystem::extrapolate_multipliers() {
  for (std::size_t k = 0; k < multipliers_.size(); ++k) {
    const int first = dof_.first[dof_.variable_of_closure(static_cast<int>(k))];
    for (int i = 0; i < multipliers_[k].size(); ++i)
      multipliers_[k][i] = state_->history.increments[0][dof_.equation[first + i]];
  }
}

void StepSystem::update_multipliers(const Eigen::VectorXd& increment) {
  for (std::size_t k = 0; k < multipliers_.size(); ++k) {
    const int first = dof_.first[dof_.variable_of_closure(static_cast<int>(k))];
    for (int i = 0; i < multipliers_[k].size(); ++i) multipliers_[k][i] += increment[dof_.equation[first + i]];
  }
}

void StepSystem::accept_multipliers(State& state) const {
  for (std::size_t k = 0; k < multipliers_.size(); ++k) {
    const int first = dof_.first[dof_.variable_of_closure(static_cast<int>(k))];
    for (int i = 0; i < multipliers_[k].size(); ++i)
      state.history.increments[0][dof_.equation[first + i]] = multipliers_[k][i];
  }
}

}  // namespace flexarm
