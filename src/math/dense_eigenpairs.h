#pragma once
/// All eigenvalues of dense matrices. Each kind is in a file of its own: their solvers take long to compile.

#include <Eigen/Core>

namespace flexarm {

struct Eigenpairs {
  Eigen::VectorXcd values;   ///< in no order
  Eigen::MatrixXcd vectors;  ///< their columns, of length 1
};

/// @throws std::runtime_error if the iteration does not converge
Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix);

/// The same after scaling coordinates, see balanced().
Eigenpairs balanced_eigenpairs(const Eigen::MatrixXd& matrix);

struct SymmetricEigenpairs {
  Eigen::VectorXd values;   ///< the smallest first
  Eigen::MatrixXd vectors;  ///< their columns, orthonormal
};

/// Of a symmetric matrix; its lower triangle is read.
SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);

}  // namespace flexarm
