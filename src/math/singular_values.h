#pragma once
/// Singular value decompositions. In a file of its own, since Eigen's takes long to compile.

#include <Eigen/Core>

namespace flexarm {

/// matrix = left diag(values) right^T.
struct SingularValues {
  Eigen::VectorXd values;  ///< in decreasing order
  Eigen::MatrixXd left, right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

}  // namespace flexarm
