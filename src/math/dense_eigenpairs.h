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

struct SymmetricEigenpairs {
  Eigen::VectorXd values;   ///< the smallest first
  Eigen::MatrixXd vectors;  ///< their columns, orthonormal
};

/// Of a symmetric matrix; its lower triangle is read.
SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);

/// Turns columns of `vectors` by Jacobi's rotations until `matrix`, which becomes R^T matrix R with vectors R, is
/// diagonal: each entry is small beside the two of the diagonal that it couples, not only beside the largest, so that
/// small eigenvalues keep the digits that the entries have (Demmel and Veselic 1992).
void diagonalise(Eigen::MatrixXd& matrix, Eigen::MatrixXd& vectors);

}  // namespace flexarm
