#pragma once
/// Kept in a file of its own: Eigen's takes long to compile.

#include <Eigen/Core>

namespace flexarm {

/// matrix = left diag(values) right^T.
struct SingularValues {
  Eigen::VectorXd values;  ///< the largest first
  Eigen::MatrixXd left, right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

}  // namespace flexarm
