#include "math/least_squares.h"

#include <Eigen/QR>

namespace flexarm {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::VectorXd smallest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

std::vector<Eigen::Index> independent_rows(const Eigen::MatrixXd& matrix, double threshold) {
  // Pivoting takes independent columns of the transpose first.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(matrix.transpose());
  if (qr.maxPivot() <= threshold) return {};
  const auto& rows = qr.colsPermutation().indices();
  return {rows.data(), rows.data() + qr.rank()};
}

}  // namespace flexarm
