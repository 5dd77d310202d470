#include "integrators/dead_point.h"

#include <algorithm>

#include "joints/kinematics.h"
#include "math/least_squares.h"

namespace flexarm {
namespace {

/// A constraint counts as dependent on other constraints if they leave less than this part of it, relative to the
/// largest constraint.
constexpr double kDependent = 0.01;

/// The first closure with a constraint that depends on others. -1 if there is none.
int dependent_closure(const Model& model, const DegreesOfFreedom& dof, Configuration configuration) {
  std::vector<bool> is_free(dof.scalar_count);
  for (int i = 0; i < dof.scalar_count; ++i) is_free[i] = dof.equation[i] >= 0;
  std::vector<int> closures;  // per row
  for_each_multiplier(model, dof, [&](int closure, int, int) { closures.push_back(closure); });
  const Kinematics kinematics(model, dof, std::move(configuration));
  const ConstraintRows jacobian = closure_jacobian(kinematics, Constraints::WithMultipliers);
  for (const ConstraintGroup& group : independent_groups(with_columns(jacobian, is_free))) {
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
  // The dimensions may make the loop nearly singular from the start.
  if (dependent_closure(model, dof, initial_configuration(model)) >= 0) return -1;
  return dependent_closure(model, dof, configuration_of(state));
}

}  // namespace flexarm
