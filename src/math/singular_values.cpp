#include "math/singular_values.h"

#include <Eigen/SVD>

namespace flexarm {

SingularValues singular_values(const Eigen::MatrixXd& matrix) {
  // Jacobi rotations are also accurate for small singular values.
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {decomposition.singularValues(), decomposition.matrixU(), decomposition.matrixV()};
}

}  // namespace flexarm
