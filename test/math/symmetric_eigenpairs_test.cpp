// Tests eigenvalues and exponentials of matrices whose entries have very different sizes.
#include <cmath>

#include <gtest/gtest.h>

#include "math/dense_eigenpairs.h"
#include "math/matrix_exponential.h"

namespace flexarm {
namespace {

using Eigen::MatrixXd;

/// Returns a matrix of ones on the diagonal and 1/2 elsewhere, with coordinates scaled by 1e10, 1 and 1e-10.
MatrixXd graded() {
  const Eigen::Vector3d scales(1e10, 1, 1e-10);
  MatrixXd matrix = MatrixXd::Constant(3, 3, 0.5);
  matrix.diagonal().setOnes();
  return scales.asDiagonal() * matrix * scales.asDiagonal();
}

// The leading minors of the unscaled matrix are 1, 3/4 and 1/2. The eigenvalues are the ratios of successive minors
// times the squares of the scales, to within 1e-20.
TEST(Diagonalise, SmallEigenvaluesKeepTheirDigits) {
  MatrixXd matrix = graded(), vectors = MatrixXd::Identity(3, 3);
  diagonalise(matrix, vectors);
  EXPECT_NEAR(matrix(0, 0) / 1e20, 1, 1e-14);
  EXPECT_NEAR(matrix(1, 1), 0.75, 1e-14);
  EXPECT_NEAR(matrix(2, 2) / 1e-20, 0.5 / 0.75, 1e-14);
  EXPECT_LT((vectors.transpose() * vectors - MatrixXd::Identity(3, 3)).norm(), 1e-14);
}

TEST(Diagonalise, OfAMatrixThatIsNotDefinite) {
  MatrixXd matrix(3, 3), vectors = MatrixXd::Identity(3, 3);
  matrix << 0, 2, 0, 2, 0, 0, 0, 0, 0;
  const MatrixXd before = matrix;
  diagonalise(matrix, vectors);
  EXPECT_NEAR(std::abs(matrix(0, 0)), 2, 1e-14);
  EXPECT_NEAR(matrix(0, 0) + matrix(1, 1), 0, 1e-14);
  EXPECT_EQ(matrix(2, 2), 0);
  EXPECT_LT((vectors.transpose() * before * vectors - matrix).norm(), 1e-14);
}

TEST(MatrixExponential, OfARotation) {
  for (const double angle : {1e-9, 0.3, 4.0, 100.0}) {
    const MatrixXd rates = (MatrixXd(2, 2) << 0, -angle, angle, 0).finished();
    const MatrixXd change = matrix_exponential_less_identity(rates);
    EXPECT_NEAR(change(0, 0), -2 * std::pow(std::sin(0.5 * angle), 2), 1e-14 * (1 + angle));
    EXPECT_NEAR(change(1, 0), std::sin(angle), 1e-14 * std::min(angle, 1.0) * (1 + angle));
  }
}

// A computation of exp(A) would lose digits that are small beside 1 in the first squarings.
TEST(MatrixExponential, SlowOnesKeepTheirDigitsBesideFastOnes) {
  const MatrixXd rates = Eigen::Vector3d(-1e13, -1, -1e-12).asDiagonal();
  const MatrixXd change = matrix_exponential_less_identity(rates);
  EXPECT_NEAR(change(0, 0), -1, 1e-14);
  EXPECT_NEAR(change(1, 1), std::expm1(-1.0), 1e-13);
  EXPECT_NEAR(change(2, 2) / -1e-12, 1, 1e-12);
}

TEST(MatrixExponential, OfNothing) {
  EXPECT_EQ(matrix_exponential_less_identity(MatrixXd(0, 0)).size(), 0);
  EXPECT_TRUE(matrix_exponential_less_identity(MatrixXd::Zero(2, 2)).isZero(0));
}

}  // namespace
}  // namespace flexarm
