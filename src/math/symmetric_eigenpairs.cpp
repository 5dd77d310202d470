#include <cassert>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

/// Off-diagonal entries below kCoupling, relative to the diagonal entries that they couple, count as zero. About five
/// sweeps are usually enough.
constexpr double kCoupling = 1e-14;
constexpr int kMostSweeps = 20;

}  // namespace

SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix) {
  assert(matrix.rows() == matrix.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

void diagonalise(Eigen::MatrixXd& matrix, Eigen::MatrixXd& vectors) {
  assert(matrix.rows() == matrix.cols() && vectors.cols() == matrix.cols());
  bool turns = true;
  for (int sweep = 0; sweep < kMostSweeps && turns; ++sweep) {
    turns = false;
    for (Eigen::Index i = 0; i + 1 < matrix.rows(); ++i)
      for (Eigen::Index j = i + 1; j < matrix.rows(); ++j) {
        const double coupling = 0.5 * (matrix(i, j) + matrix(j, i));
        const double most = kCoupling * std::sqrt(std::abs(matrix(i, i))) * std::sqrt(std::abs(matrix(j, j)));
        if (!(std::abs(coupling) > most)) continue;
        Eigen::JacobiRotation<double> rotation;
        if (!rotation.makeJacobi(matrix(i, i), coupling, matrix(j, j))) continue;
        matrix.applyOnTheLeft(i, j, rotation.adjoint());
        matrix.applyOnTheRight(i, j, rotation);
        vectors.applyOnTheRight(i, j, rotation);
        turns = true;
      }
  }
}

}  // namespace flexarm
