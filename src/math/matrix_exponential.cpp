#include "math/matrix_exponential.h"

#include <unsupported/Eigen/MatrixFunctions>

#include "math/hessenberg.h"

namespace flexarm {

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& matrix) {
  const Balanced balanced = flexarm::balanced(matrix);
  const Eigen::MatrixXd exponential = balanced.matrix.exp();
  return balanced.scales.asDiagonal() * exponential * balanced.scales.cwiseInverse().asDiagonal();
}

}  // namespace flexarm
