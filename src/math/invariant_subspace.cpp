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

/// Basis of the invariant subspace of the `wanted` places on the diagonal. Rotations that exchange neighbours move
/// these to the top.
Eigen::MatrixXd subspace(SchurForm form, const std::vector<bool>& wanted) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < form.triangle.rows(); ++i) {
    if (!wanted[static_cast<std::size_t>(i)]) continue;
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

std::vector<Eigen::MatrixXd> invariant_subspaces(const Eigen::MatrixXd& matrix, int count,
                                                 const std::function<int(std::complex<double>)>& group_of) {
  assert(matrix.rows() == matrix.cols());
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(matrix.cast<std::complex<double>>());
  if (schur.info() != Eigen::Success) throw std::runtime_error("the eigenvalues are not found");
  std::vector<std::vector<bool>> wanted(static_cast<std::size_t>(count));
  for (std::vector<bool>& group : wanted) group.resize(static_cast<std::size_t>(matrix.rows()), false);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    wanted[static_cast<std::size_t>(group_of(schur.matrixT()(i, i)))][static_cast<std::size_t>(i)] = true;
  std::vector<Eigen::MatrixXd> bases;
  bases.reserve(wanted.size());
  for (const std::vector<bool>& group : wanted) bases.push_back(subspace({schur.matrixT(), schur.matrixU()}, group));
  return bases;
}

}  // namespace flexarm
