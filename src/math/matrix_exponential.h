#pragma once
/// Kept in a file of its own: Eigen's takes long to compile.

#include <Eigen/Core>

namespace flexarm {

/// exp(A) of a square matrix, by scaling and squaring of the balanced one.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& matrix);

}  // namespace flexarm
