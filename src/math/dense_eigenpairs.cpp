#include "math/dense_eigenpairs.h"

#include <cmath>
#include <utility>

#include <Spectra/LinAlg/UpperHessenbergEigen.h>
#include <Eigen/Householder>

namespace flexarm {
namespace {

/// A = Q H Q^T, where H has one diagonal below its main one.
struct Hessenberg {
  Eigen::MatrixXd reduced, basis;
};

/// By a reflection for each column. Eigen's HessenbergDecomposition does the same, but takes 140 MB more to compile.
Hessenberg hessenberg(Eigen::MatrixXd matrix) {
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

}  // namespace

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Hessenberg hessenberg = flexarm::hessenberg(matrix);
  Spectra::UpperHessenbergEigen<double> solver(hessenberg.reduced);
  return {solver.eigenvalues(), hessenberg.basis * solver.eigenvectors()};
}

Eigenpairs balanced_eigenpairs(Eigen::MatrixXd matrix) {
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
  Eigenpairs pairs = dense_eigenpairs(matrix);
  pairs.vectors = scales.asDiagonal() * pairs.vectors;
  pairs.vectors.colwise().normalize();
  return pairs;
}

}  // namespace flexarm
