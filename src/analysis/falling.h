#pragma once
/// Inertia of parts that nothing carries: a mechanism at rest under loads that are not in balance.

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// How parts on joints of the world begin to move from rest: without turning, all of a part's masses alike. A falling
/// robot does not feel its weight, since its inertia balances it.
struct Fall {
  std::vector<NodalLoad> inertia;                     ///< -m a of each mass [N]: loads that do not turn
  std::vector<std::pair<int, double>> accelerations;  ///< of these scalars of DegreesOfFreedom [m/s^2]
};

/// Empty in an equilibrium, and if no joint on the world lets its link move along. `residual`: by which forces are out
/// of balance, in equations. Accelerations with which parts begin to turn are left out.
Fall fall_of(const Model& model, const DegreesOfFreedom& dof, const State& state, const Eigen::VectorXd& residual);

}  // namespace flexarm
