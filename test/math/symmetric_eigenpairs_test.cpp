// Tests eigenvalues, exponentials and products of matrices whose entries have very different sizes.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "math/dense_eigenpairs.h"
#include "math/long_product.h"
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

// The first and the last term of each sum cancel. A double has no digit of the one between them.
TEST(LongProduct, KeepsTheDigitsOfTermsThatCancel) {
  if (std::numeric_limits<long double>::digits < 64) GTEST_SKIP() << "a long double has the digits of a double here";
  for (const Eigen::Index columns : {1, 2, 3, 4, 5}) {
    const MatrixXd left = (MatrixXd(2, 3) << 1, 0x1p-60, -1, 3, 0x1p-58, -3).finished();
    const MatrixXd right = MatrixXd::Ones(3, 1) * Eigen::RowVectorXd::LinSpaced(columns, 1, double(columns));
    const LongMatrix product = long_product(left, right), wide = long_product(right.transpose(), left.transpose());
    ASSERT_EQ(product.rows(), 2);
    ASSERT_EQ(product.cols(), columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
      EXPECT_EQ(product(0, j), 0x1p-60L * (j + 1));
      EXPECT_EQ(product(1, j), 0x1p-58L * (j + 1));
    }
    EXPECT_TRUE(wide == product.transpose());
  }
  EXPECT_EQ(long_product(MatrixXd(2, 0), MatrixXd(0, 3)), LongMatrix::Zero(2, 3));
}

}  // namespace
}  // namespace flexarm
