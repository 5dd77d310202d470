#pragma once
/// All eigenvalues of a dense matrix. Kept in a file of its own: Eigen's solver takes long to compile.

#include <Eigen/Core>

namespace flexarm {

struct Eigenpairs {
  Eigen::VectorXcd values;   ///< in no order
  Eigen::MatrixXcd vectors;  ///< their columns, of length 1
};

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix);

}  // namespace flexarm
