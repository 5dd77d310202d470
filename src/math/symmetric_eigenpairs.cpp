#include <Eigen/Eigenvalues>

#include "math/dense_eigenpairs.h"

namespace flexarm {

SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace flexarm
