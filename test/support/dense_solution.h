#pragma once
/// Solves dense systems of equations for comparisons. This is a separate file because Eigen's factorisations take long
/// to compile.

#include <Eigen/Core>

namespace flexarm::test {

/// Returns x with matrix * x = right, for a square matrix, by full pivoting.
Eigen::MatrixXd solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
/// The same for complex numbers, by partial pivoting.
Eigen::VectorXcd complex_solution(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right);

/// Returns whether a square matrix has full rank, to within round-off.
bool is_invertible(const Eigen::MatrixXd& matrix);

}  // namespace flexarm::test
