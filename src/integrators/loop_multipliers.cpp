#include "integrators/loop_multipliers.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "joints/kinematics.h"

namespace flexarm {

LoopMultipliers::LoopMultipliers(const StepConfiguration& configuration) : configuration_(configuration) {
  for (const LoopClosure& closure : configuration.model().closures)
    values_.push_back(ReleasedVector::Zero(static_cast<Eigen::Index>(closure.constraints.size())));
}

template <class Visit>
void LoopMultipliers::for_each(const Visit& visit) const {
  for_each_multiplier(configuration_.model(), configuration_.degrees_of_freedom(), visit);
}

void LoopMultipliers::begin() {
  for (ReleasedVector& values : values_) values.setZero();
}

void LoopMultipliers::extrapolate(const IncrementHistory& history) {
  for_each([&](int k, int i, int equation) { values_[k][i] = history.increments[0][equation]; });
}

void LoopMultipliers::update(const Eigen::VectorXd& increment) {
  assert(increment.size() == configuration_.degrees_of_freedom().unknowns);
  for_each([&](int k, int i, int equation) { values_[k][i] += increment[equation]; });
}

double LoopMultipliers::end_weight() const {
  return configuration_.has_incremental_joints() ? 0.5 : 1.0;
}

Vector6 LoopMultipliers::on_child(int closure) const {
  assert(closure >= 0 && static_cast<std::size_t>(closure) < values_.size());
  const LoopClosure& loop = configuration_.model().closures[closure];
  const ClosurePoses begin = closure_poses(loop, configuration_.begin()),
                     end = closure_poses(loop, configuration_.end());
  Vector6 sum = Vector6::Zero();
  ClosureMaps maps;
  for (std::size_t i = 0; i < loop.constraints.size(); ++i) {
    closure_maps(loop, loop.constraints[i], begin, end, end_weight(), maps);
    sum += values_[closure][static_cast<Eigen::Index>(i)] * maps.left.child;
  }
  return sum;
}

void LoopMultipliers::evaluate(Balance& balance) const {
  const std::vector<LoopClosure>& closures = configuration_.model().closures;
  ClosureMaps maps;
  for (int k = 0; k < static_cast<int>(closures.size()); ++k) {
    const LoopClosure& closure = closures[k];
    const ClosurePoses begin = closure_poses(closure, configuration_.begin()),
                       end = closure_poses(closure, configuration_.end());
    for (int i = 0; i < static_cast<int>(closure.constraints.size()); ++i) {
      closure_maps(closure, closure.constraints[i], begin, end, end_weight(), maps);
      balance.residual.add_closure(k, i, values_[k][i], maps);
      if (balance.tangent) balance.tangent->add_closure(k, i, values_[k][i], maps);
    }
  }
}

void LoopMultipliers::remember(IncrementHistory& history) const {
  for_each([&](int k, int i, int equation) { history.increments[0][equation] = values_[k][i]; });
}

LoopMultipliers::Opening LoopMultipliers::largest_opening() const {
  const Model& model = configuration_.model();
  Opening largest;
  for (int k = 0; k < static_cast<int>(model.closures.size()); ++k) {
    const LoopClosure& closure = model.closures[k];
    for (const ClosureConstraint& constraint : closure.implied) {
      const double value = closure_value(closure, constraint, closure_poses(closure, configuration_.end()));
      const double size = std::abs(value) / constraint_scale(model, constraint);
      if (size > largest.size) largest = {size, k};
    }
  }
  return largest;
}

}  // namespace flexarm
