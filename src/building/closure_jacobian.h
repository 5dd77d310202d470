#pragma once
/// Loops of rigid links: their constraints as a matrix (internal to building/).

#include <vector>

#include <Eigen/SparseCore>

#include "model/degrees_of_freedom.h"
#include "model/model.h"

namespace flexarm {

/// Rows: the constraints of all closures, kept ones then implied ones, closure by closure.
using ConstraintRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Scaled constraints are independent if a pivot is larger than this part of the largest one of its group.
constexpr double kIndependent = 1e-6;

/// Per scalar of the nodes and joints: the model's length scale where it is a displacement, 1 where it is a rotation.
Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof);

/// Derivatives of the constraints' values with respect to the scalars of `dof` at the model's start, both in parts of
/// their scales; columns of slaves and of following coordinates are folded into their masters' and zero.
ConstraintRows closure_jacobian(const Model& model, const DegreesOfFreedom& dof);

/// The other columns are zero.
ConstraintRows with_columns(ConstraintRows jacobian, const std::vector<bool>& is_kept);

/// Rows that share columns, directly or through others, and what is not zero of them. A mechanism of many loops has as
/// many small groups, unless they hang together.
struct ConstraintGroup {
  std::vector<int> rows, columns;
  Eigen::MatrixXd block;
};
std::vector<ConstraintGroup> independent_groups(const ConstraintRows& jacobian);

}  // namespace flexarm
