#pragma once
/// Dense systems of equations to compare with, solved in one place: Eigen's factorisations take long to compile.

#include <Eigen/Core>

namespace flexarm::test {

/// x with matrix x = right, of a square matrix, by full pivoting.
Eigen::MatrixXd solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

}  // namespace flexarm::test
