#include "integrators/dead_point.h"

#include <algorithm>

#include "joints/closure_jacobian.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// A constraint counts as dependent on other constraints if they leave less than this part of it, relative to the
/// largest constraint.
constexpr double kDependent = 0.01;

std::vector<int> closure_of_rows(const Model& model) {
  std::vector<int> closures;
  for (std::size_t k = 0; k < model.closures.size(); ++k)
    closures.insert(closures.end(), model.closures[k].constraints.size(), static_cast<int>(k));
  return closures;
}

/// In the initial configuration of a model without implied constraints: the first closure with a constraint that
/// depends on others. -1 if there is none.
int dependent_closure(const Model& model, const DegreesOfFreedom& dof) {
  std::vector<bool> is_free(dof.scalar_count);
  for (int i = 0; i < dof.scalar_count; ++i) is_free[i] = dof.equation[i] >= 0;
  const std::vector<int> closures = closure_of_rows(model);
  for (const ConstraintGroup& group : independent_groups(with_columns(closure_jacobian(model, dof), is_free))) {
    const std::vector<Eigen::Index> independent = independent_rows(group.block, kDependent);
    for (std::size_t i = 0; i < group.rows.size(); ++i)
      if (std::find(independent.begin(), independent.end(), static_cast<Eigen::Index>(i)) == independent.end())
        return closures[group.rows[i]];
  }
  return -1;
}

}  // namespace

int closure_at_dead_point(const Model& model, const DegreesOfFreedom& dof, const State& state) {
  if (model.closures.empty()) return -1;
  Model moved = model;
  for (LoopClosure& closure : moved.closures) closure.implied.clear();
  if (dependent_closure(moved, dof) >= 0) return -1;  // the dimensions make the loop nearly singular from the start
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) moved.nodes[i] = node_pose(state.nodes[i]);
  moved.initial_released = state.released;
  return dependent_closure(moved, dof);
}

}  // namespace flexarm
