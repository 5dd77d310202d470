#include "support/dense_solution.h"

#include <Eigen/LU>

namespace flexarm::test {

Eigen::MatrixXd solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.fullPivLu().solve(right);
}

}  // namespace flexarm::test
