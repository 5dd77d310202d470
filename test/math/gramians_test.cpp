// Tests Gramians against the equations that define them, and bases of invariant subspaces.
#include "math/gramians.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "math/invariant_subspace.h"

namespace flexarm {
namespace {

using Eigen::MatrixXd;

/// Returns a matrix with poles at -1 +- 20 i, -0.01 +- 3 i, and four real ones between -1e4 and -0.5, coupled.
MatrixXd decaying_matrix() {
  MatrixXd matrix = MatrixXd::Zero(8, 8);
  matrix.topLeftCorner(2, 2) << -1, 20, -20, -1;
  matrix.block<2, 2>(2, 2) << -0.01, 3, -3, -0.01;
  matrix.diagonal().tail(4) << -1e4, -50, -2, -0.5;
  for (int i = 0; i < 8; ++i)
    for (int j = i + 2; j < 8; ++j) matrix(i, j) = 0.3 * (i + 1) - 0.2 * j;
  return matrix;
}

TEST(Gramians, SolveTheEquationsOfLyapunov) {
  const MatrixXd a = decaying_matrix();
  MatrixXd b(8, 2), c(3, 8);
  for (int i = 0; i < 8; ++i) {
    b.row(i) << 1 + 0.1 * i, i % 3 - 1;
    c.col(i) << 0.5 * i, 1, (i + 1) % 2;
  }
  const GramianRoots roots = gramian_roots(a, b, c);
  const MatrixXd p = roots.reached * roots.reached.transpose(), q = roots.seen.transpose() * roots.seen;
  // The iteration inverts a matrix. The smallest real part of its eigenvalues, 0.01, is much smaller than the largest
  // eigenvalue, 1e4, and the ratio multiplies round-off.
  const double round_off = 1e-15 * 1e4 / 0.01;
  EXPECT_LT((a * p + p * a.transpose() + b * b.transpose()).norm(), round_off * a.norm() * p.norm());
  EXPECT_LT((a.transpose() * q + q * a + c.transpose() * c).norm(), round_off * a.norm() * q.norm());
}

TEST(InvariantSubspaces, AreMappedIntoThemselves) {
  const MatrixXd a = decaying_matrix();
  std::vector<std::complex<double>> slow;
  for (const std::complex<double> value : a.eigenvalues())
    if (value.real() > -0.6) slow.push_back(value + 1e-9);
  ASSERT_EQ(slow.size(), 3u);
  const auto [wanted, others] = invariant_subspaces(a, slow);
  for (const MatrixXd& basis : {wanted, others}) {
    EXPECT_LT((basis.transpose() * basis - MatrixXd::Identity(basis.cols(), basis.cols())).norm(), 1e-13);
    EXPECT_LT((a * basis - basis * (basis.transpose() * a * basis)).norm(), 1e-13 * a.norm());
  }
  ASSERT_EQ(wanted.cols(), 3);
  for (const std::complex<double> value : (wanted.transpose() * a * wanted).eigenvalues())
    EXPECT_GT(value.real(), -0.6);
  EXPECT_EQ(others.cols(), 5);
  EXPECT_EQ(invariant_subspaces(a, {}).wanted.cols(), 0);
}

}  // namespace
}  // namespace flexarm
