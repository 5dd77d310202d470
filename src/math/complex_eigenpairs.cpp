#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "math/dense_eigenpairs.h"

namespace flexarm {

Eigenpairs complex_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(matrix.cast<std::complex<double>>());
  if (solver.info() != Eigen::Success)
    throw std::runtime_error(fmt::format(
        "the eigenvalues of a matrix of {} rows are not found: no iteration for them converges", matrix.rows()));
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace flexarm
