#include "math/invariant_subspace.h"

#include <cassert>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "math/least_squares.h"

namespace flexarm {

namespace {

/// Schur's form of a matrix: basis triangle basis^*.
struct SchurForm {
  Eigen::MatrixXcd triangle, basis;
};

/// Basis of the invariant subspace of the eigenvalues at these places of the diagonal. Rotations that exchange
/// neighbours move these to the top.
Eigen::MatrixXd subspace(SchurForm form, const std::vector<bool>& is_wanted) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < form.triangle.rows(); ++i) {
    if (!is_wanted[static_cast<std::size_t>(i)]) continue;
    for (Eigen::Index k = i - 1; k >= count; --k) {
      Eigen::JacobiRotation<std::complex<double>> exchange;
      exchange.makeGivens(form.triangle(k, k + 1), form.triangle(k + 1, k + 1) - form.triangle(k, k));
      form.triangle.applyOnTheLeft(k, k + 1, exchange.adjoint());
      form.triangle.applyOnTheRight(k, k + 1, exchange);
      form.basis.applyOnTheRight(k, k + 1, exchange);
      form.triangle(k + 1, k) = 0;
    }
    ++count;
  }
  Eigen::MatrixXd parts(form.basis.rows(), 2 * count);
  parts << form.basis.leftCols(count).real(), form.basis.leftCols(count).imag();
  return column_space(parts, count);
}

}  // namespace

InvariantSubspaces invariant_subspaces(const Eigen::MatrixXd& matrix, const std::vector<std::complex<double>>& wanted) {
  assert(matrix.rows() == matrix.cols() && wanted.size() <= static_cast<std::size_t>(matrix.rows()));
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(matrix.cast<std::complex<double>>());
  if (schur.info() != Eigen::Success) throw std::runtime_error("the eigenvalues are not found");
  const Eigen::VectorXcd values = schur.matrixT().diagonal();
  std::vector<bool> is_wanted(static_cast<std::size_t>(values.size()), false);
  for (const std::complex<double> value : wanted) {
    Eigen::Index nearest = -1;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (!is_wanted[static_cast<std::size_t>(i)] &&
          (nearest < 0 || std::abs(values[i] - value) < std::abs(values[nearest] - value)))
        nearest = i;
    is_wanted[static_cast<std::size_t>(nearest)] = true;
  }
  std::vector<bool> is_other = is_wanted;
  is_other.flip();
  return {subspace({schur.matrixT(), schur.matrixU()}, is_wanted),
          subspace({schur.matrixT(), schur.matrixU()}, is_other)};
}

}  // namespace flexarm
