#include "math/hessenberg.h"

#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Householder>

namespace flexarm {

Balanced balanced(Eigen::MatrixXd matrix) {
  assert(matrix.rows() == matrix.cols());
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(matrix.rows());
  for (bool changes = true; changes;) {
    changes = false;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const double own = std::abs(matrix(i, i));
      const double row = matrix.row(i).cwiseAbs().sum() - own, column = matrix.col(i).cwiseAbs().sum() - own;
      if (!(row > 0 && column > 0)) continue;
      const double scale = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!(column * scale + row / scale < 0.95 * (row + column))) continue;
      matrix.col(i) *= scale;
      matrix.row(i) /= scale;
      scales[i] *= scale;
      changes = true;
    }
  }
  return {std::move(matrix), std::move(scales)};
}

// Uses a Householder reflection for each column. Eigen's HessenbergDecomposition does the same, but needs 140 MB more
// memory to compile.
Hessenberg hessenberg(Eigen::MatrixXd matrix) {
  assert(matrix.rows() == matrix.cols());
  const Eigen::Index n = matrix.rows();
  Hessenberg out{std::move(matrix), Eigen::MatrixXd::Identity(n, n)};
  Eigen::VectorXd directions(n), workspace(n);
  for (Eigen::Index k = 0; k + 2 < n; ++k) {
    const Eigen::Index below = n - k - 1;
    auto direction = directions.head(below - 1);
    double factor, length;
    out.reduced.col(k).tail(below).makeHouseholder(direction, factor, length);
    out.reduced.bottomRows(below).applyHouseholderOnTheLeft(direction, factor, workspace.data());
    out.reduced.rightCols(below).applyHouseholderOnTheRight(direction, factor, workspace.data());
    out.basis.rightCols(below).applyHouseholderOnTheRight(direction, factor, workspace.data());
    out.reduced.col(k).tail(below - 1).setZero();
  }
  return out;
}

Eigen::MatrixXcd shifted_solution(const Eigen::MatrixXd& reduced, std::complex<double> shift, Eigen::MatrixXcd rights) {
  assert(reduced.rows() == reduced.cols() && rights.rows() == reduced.rows());
  const Eigen::Index n = reduced.rows();
  Eigen::MatrixXcd rows = -reduced.cast<std::complex<double>>();
  rows.diagonal().array() += shift;
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    if (std::abs(rows(k + 1, k)) > std::abs(rows(k, k))) {
      rows.row(k).swap(rows.row(k + 1));
      rights.row(k).swap(rights.row(k + 1));
    }
    if (rows(k + 1, k) == 0.0) continue;
    const std::complex<double> factor = rows(k + 1, k) / rows(k, k);
    rows.row(k + 1).tail(n - k) -= factor * rows.row(k).tail(n - k);
    rights.row(k + 1) -= factor * rights.row(k);
  }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    rights.row(k) -= rows.row(k).tail(n - k - 1) * rights.bottomRows(n - k - 1);
    rights.row(k) /= rows(k, k);
  }
  return rights;
}

}  // namespace flexarm
