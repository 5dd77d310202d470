#include "math/dense_eigenpairs.h"

#include <cassert>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "math/hessenberg.h"

namespace flexarm {
namespace {

/// Finds the pairs by the real QR iteration. Returns false if it does not converge.
bool find_pairs(const Eigen::MatrixXd& matrix, Eigenpairs& pairs) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return false;
  pairs = {solver.eigenvalues(), solver.eigenvectors()};
  return pairs.values.allFinite() && pairs.vectors.allFinite();
}

/// The same for the balanced matrix, see balanced().
bool find_balanced_pairs(const Eigen::MatrixXd& matrix, Eigenpairs& pairs) {
  const Balanced balanced = flexarm::balanced(matrix);
  if (!find_pairs(balanced.matrix, pairs)) return false;
  pairs.vectors = balanced.scales.asDiagonal() * pairs.vectors;
  pairs.vectors.colwise().normalize();
  return true;
}

void require_finite(const Eigen::MatrixXd& matrix) {
  if (matrix.allFinite()) return;
  throw std::runtime_error(fmt::format(
      "the eigenvalues of a matrix of {} rows are not found: not all of its entries are finite", matrix.rows()));
}

}  // namespace

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix) {
  assert(matrix.rows() == matrix.cols());
  require_finite(matrix);
  Eigenpairs pairs;
  if (find_pairs(matrix, pairs) || find_balanced_pairs(matrix, pairs)) return pairs;
  return complex_eigenpairs(matrix);
}

}  // namespace flexarm
