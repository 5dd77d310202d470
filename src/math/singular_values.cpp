#include "math/singular_values.h"

#include <Eigen/SVD>

namespace flexarm {

SingularValues singular_values(const Eigen::MatrixXd& matrix) {
  // Rotations keep the digits of small ones, too.
  const Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {decomposition.singularValues(), decomposition.matrixU(), decomposition.matrixV()};
}

}  // namespace flexarm
