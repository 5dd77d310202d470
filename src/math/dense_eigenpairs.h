#pragma once
/// All eigenvalues of dense matrices. Each kind is in a file of its own: their solvers take long to compile.

#include <Eigen/Core>

namespace flexarm {

struct Eigenpairs {
  Eigen::VectorXcd values;   ///< in no order
  Eigen::MatrixXcd vectors;  ///< their columns, of length 1
};

/// By the real QR iteration; where it does not converge, after balancing, and then by complex_eigenpairs().
/// @throws std::runtime_error with words of our own if none converges, or the matrix is not finite
Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix);

/// The same by the complex QR iteration, which takes four times as long and converges where the real one does not.
/// @throws std::runtime_error if it does not converge
Eigenpairs complex_eigenpairs(const Eigen::MatrixXd& matrix);

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
