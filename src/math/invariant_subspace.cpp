#include "math/invariant_subspace.h"

#include <cassert>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "math/least_squares.h"

namespace flexarm {

Eigen::MatrixXd invariant_subspace(const Eigen::MatrixXd& matrix,
                                   const std::function<bool(std::complex<double>)>& wanted) {
  assert(matrix.rows() == matrix.cols());
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(matrix.cast<std::complex<double>>());
  if (schur.info() != Eigen::Success) throw std::runtime_error("the eigenvalues are not found");
  Eigen::MatrixXcd triangle = schur.matrixT(), basis = schur.matrixU();
  // Move the wanted eigenvalues to the top of the diagonal, by rotations that exchange neighbours.
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < triangle.rows(); ++i) {
    if (!wanted(triangle(i, i))) continue;
    for (Eigen::Index k = i - 1; k >= count; --k) {
      Eigen::JacobiRotation<std::complex<double>> exchange;
      exchange.makeGivens(triangle(k, k + 1), triangle(k + 1, k + 1) - triangle(k, k));
      triangle.applyOnTheLeft(k, k + 1, exchange.adjoint());
      triangle.applyOnTheRight(k, k + 1, exchange);
      basis.applyOnTheRight(k, k + 1, exchange);
      triangle(k + 1, k) = 0;
    }
    ++count;
  }
  Eigen::MatrixXd parts(matrix.rows(), 2 * count);
  parts << basis.leftCols(count).real(), basis.leftCols(count).imag();
  return column_space(parts, count);
}

}  // namespace flexarm
