#pragma once
/// The constraints of loops of rigid links as a matrix.

#include <vector>

#include <Eigen/SparseCore>

#include "model/degrees_of_freedom.h"
#include "model/model.h"

namespace flexarm {

/// One row for each constraint: closure by closure, first the kept constraints and then the implied ones.
using ConstraintRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Scaled constraints are independent if their pivots are larger than this part of the largest one in the group.
constexpr double kIndependent = 1e-6;

/// For each scalar of nodes and joints: the model's length scale if it is a displacement, 1 if it is a rotation.
Eigen::VectorXd scalar_scales(const Model& model, const DegreesOfFreedom& dof);

/// Derivatives of the constraints' values by the scalars of `dof`, at the model's start. Values and scalars are divided
/// by their scales. Columns of slaves and of following coordinates are folded into those of their masters, and are then
/// zero.
ConstraintRows closure_jacobian(const Model& model, const DegreesOfFreedom& dof);

/// Sets the other columns to zero.
ConstraintRows with_columns(ConstraintRows jacobian, const std::vector<bool>& is_kept);

/// Rows that share columns, directly or through other rows, and their entries that are not zero. A mechanism of many
/// loops has many small groups, unless its loops are connected.
struct ConstraintGroup {
  std::vector<int> rows, columns;
  Eigen::MatrixXd block;
};
std::vector<ConstraintGroup> independent_groups(const ConstraintRows& jacobian);

}  // namespace flexarm
