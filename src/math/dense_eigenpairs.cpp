#include "math/dense_eigenpairs.h"

#include <Eigen/Eigenvalues>

namespace flexarm {

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace flexarm
