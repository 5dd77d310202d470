/// Solutions of dense systems; see dense_solution.h.
#include "support/dense_solution.h"

#include <Eigen/LU>

namespace flexarm::test {

Eigen::MatrixXd solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.fullPivLu().solve(right);
}

Eigen::VectorXcd complex_solution(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right) {
  return matrix.partialPivLu().solve(right);
}

bool is_invertible(const Eigen::MatrixXd& matrix) {
  return matrix.fullPivLu().isInvertible();
}

}  // namespace flexarm::test
