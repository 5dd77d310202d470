#pragma once
/// Eigenvalues and eigenvectors of dense matrices. Each kind of solver has a source file of its own, since Eigen's
/// solvers take long to compile.

#include <Eigen/Core>

namespace flexarm {

struct Eigenpairs {
  Eigen::VectorXcd values;   ///< not sorted
  Eigen::MatrixXcd vectors;  ///< columns of length 1, in the order of `values`
};

/// Computes all eigenpairs by the real QR iteration. If that does not converge, tries again after balancing, and then
/// with complex_eigenpairs().
/// @throws std::runtime_error if none of these converges, or the matrix is not finite
Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix);

/// The same by the complex QR iteration. It takes four times as long, and converges for some matrices for which the
/// real one does not.
/// @throws std::runtime_error if it does not converge
Eigenpairs complex_eigenpairs(const Eigen::MatrixXd& matrix);

struct SymmetricEigenpairs {
  Eigen::VectorXd values;   ///< in increasing order
  Eigen::MatrixXd vectors;  ///< orthonormal columns, in the order of `values`
};

/// Computes all eigenpairs of a symmetric matrix. Reads only its lower triangle.
SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);

/// Diagonalises a symmetric `matrix` by Jacobi rotations R: it becomes R^T matrix R, and `vectors` become vectors R. At
/// the end, each off-diagonal entry is small relative to the two diagonal entries that it couples, not only to the
/// largest one. So small eigenvalues are as accurate as the entries of the matrix (Demmel and Veselic 1992).
void diagonalise(Eigen::MatrixXd& matrix, Eigen::MatrixXd& vectors);

}  // namespace flexarm
