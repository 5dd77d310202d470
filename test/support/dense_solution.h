#pragma once
/// Dense systems of equations to compare with, solved in one place: Eigen's factorisations take long to compile.

#include <Eigen/Core>

namespace flexarm::test {

/// x with matrix x = right, of a square matrix, by full pivoting.
Eigen::MatrixXd solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
/// The same of complex numbers, by partial pivoting.
Eigen::VectorXcd complex_solution(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right);

/// Whether a square matrix has full rank, but for round-off.
bool is_invertible(const Eigen::MatrixXd& matrix);

}  // namespace flexarm::test
