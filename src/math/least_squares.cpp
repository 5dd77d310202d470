#include "math/least_squares.h"

#include <cassert>

#include <Eigen/LU>
#include <Eigen/QR>

namespace flexarm {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::VectorXd smallest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                       std::optional<double> threshold) {
  if (matrix.cols() == 0) return Eigen::VectorXd(0);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  if (threshold) decomposition.setThreshold(*threshold);
  return decomposition.compute(matrix).solve(right);
}

Eigen::MatrixXd square_solution(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& rights) {
  assert(matrix.rows() == matrix.cols() && rights.rows() == matrix.rows());
  if (matrix.cols() == 0) return rights;
  return matrix.partialPivLu().solve(rights);
}

std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& matrix, double threshold) {
  // Column pivoting on the transpose puts linearly independent rows first.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(matrix.transpose());
  if (qr.maxPivot() <= threshold) return {};
  const auto& rows = qr.colsPermutation().indices();
  return {rows.data(), rows.data() + qr.rank()};
}

Eigen::MatrixXd column_space(const Eigen::MatrixXd& matrix, Eigen::Index rank) {
  assert(rank >= 0 && rank <= matrix.rows() && rank <= matrix.cols());
  if (rank == 0) return Eigen::MatrixXd(matrix.rows(), 0);
  return matrix.colPivHouseholderQr().householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), rank);
}

Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& tall) {
  assert(tall.rows() >= tall.cols());
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(tall.cols()).triangularView<Eigen::Upper>();
  return triangle * qr.colsPermutation().transpose();
}

}  // namespace flexarm
