/// Tests eigenvalues of large linear operations with known eigenvalues.
#include "analysis/largest_eigenpairs.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "analysis/krylov_space.h"
#include "support/refusal.h"

namespace flexarm {
namespace {

constexpr int kRows = 600;

/// y = Q D Q x: a diagonal matrix, or one of 2 by 2 blocks, in other coordinates. Q is the reflection at a plane.
class Reflected : public LinearOperation {
 public:
  explicit Reflected(Eigen::MatrixXd middle) : middle_(std::move(middle)), normal_(middle_.rows()) {
    for (Eigen::Index i = 0; i < normal_.size(); ++i) normal_[i] = std::sin(1.0 + i * i);
    normal_.normalize();
  }
  Eigen::Index rows() const override { return middle_.rows(); }
  void apply(const double* in, double* out) const override {
    Eigen::VectorXd::Map(out, rows()) = reflected(middle_ * reflected(Eigen::VectorXd::Map(in, rows())));
  }

 private:
  Eigen::VectorXd reflected(const Eigen::VectorXd& x) const { return x - 2 * normal_.dot(x) * normal_; }

  Eigen::MatrixXd middle_;
  Eigen::VectorXd normal_;
};

double residual(const LinearOperation& operation, const Eigenpair& pair) {
  const Eigen::VectorXd real = pair.vector.real(), imaginary = pair.vector.imag();
  Eigen::VectorXd real_image(real.size()), imaginary_image(real.size());
  operation.apply(real.data(), real_image.data());
  operation.apply(imaginary.data(), imaginary_image.data());
  Eigen::VectorXcd image(real.size());
  image.real() = real_image;
  image.imag() = imaginary_image;
  return (image - pair.value * pair.vector).norm() / pair.vector.norm();
}

// Multiple eigenvalues, as of beams with round sections: 1 / k^4, four times each.
TEST(LargestEigenpairs, FindsEqualOnesAsOftenAsTheyCome) {
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(kRows, kRows);
  for (int i = 0; i < kRows; ++i) middle(i, i) = std::pow(1 + i / 4, -4.0);
  const Reflected operation(middle);
  const std::vector<Eigenpair> pairs = largest_eigenpairs(operation, 18, false, Crowded::Fail);
  ASSERT_EQ(pairs.size(), 18u);
  for (int k = 0; k < 18; ++k) {
    EXPECT_NEAR(pairs[k].value.real(), std::pow(1 + k / 4, -4.0), 1e-14) << k;
    EXPECT_NEAR(pairs[k].value.imag(), 0, 1e-14) << k;
    EXPECT_LE(residual(operation, pairs[k]), 1e-14 * 100) << k;
  }
}

// A multiple eigenvalue as of the free motions of many joints, which a block of the iteration does not contain.
TEST(LargestEigenpairs, FindsManyEqualOnes) {
  constexpr int kEqual = 61, kCount = 150;
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(kRows, kRows);
  for (int i = 0; i < kRows; ++i) middle(i, i) = i < kEqual ? 1 : std::pow(2 + i - kEqual, -4.0);
  const std::vector<Eigenpair> pairs = largest_eigenpairs(Reflected(middle), kCount, false, Crowded::Fail);
  ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kCount));
  for (int k = 0; k < kCount; ++k)
    EXPECT_NEAR(pairs[k].value.real(), k < kEqual ? 1 : std::pow(2 + k - kEqual, -4.0), 1e-13) << k;
}

TEST(LargestEigenpairs, FindsComplexOnes) {
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(kRows, kRows);
  for (int i = 0; i < kRows; i += 2) {
    const double size = std::pow(1 + i / 2, -2.0);
    middle.block<2, 2>(i, i) << size, 0.1 * size, -0.1 * size, size;
  }
  const Reflected operation(middle);
  const std::vector<Eigenpair> pairs = largest_eigenpairs(operation, 10, false, Crowded::Fail);
  for (int k = 0; k < 10; ++k) {
    const double size = std::pow(1 + k / 2, -2.0);
    EXPECT_NEAR(pairs[k].value.real(), size, 1e-13) << k;
    EXPECT_NEAR(std::abs(pairs[k].value.imag()), 0.1 * size, 1e-13) << k;
    EXPECT_LE(residual(operation, pairs[k]), 1e-12) << k;
  }
}

// An operation of rank 6: after a few vectors, the Krylov space is invariant, and must continue with other vectors.
TEST(LargestEigenpairs, GoesOnWhereTheSpaceIsInvariant) {
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(kRows, kRows);
  for (int i = 0; i < 6; ++i) middle(i, i) = 6 - i;
  const Reflected operation(middle);
  const std::vector<Eigenpair> pairs = largest_eigenpairs(operation, 6, false, Crowded::Fail);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(pairs[k].value.real(), 6 - k, 1e-13);
}

// A spectrum like that of overdamped modes: three eigenvalues are well separated. All others are near 1, and their
// distances are near round-off. (Of fewer rows all pairs are computed.)
TEST(LargestEigenpairs, OfACrowdThoseThatLieApartAreFound) {
  const int rows = 1100;
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(rows, rows);
  for (int i = 0; i < rows; ++i) middle(i, i) = i < 3 ? 5 - i : 1 - 1e-4 * i / rows;
  const Reflected operation(middle);
  const std::vector<Eigenpair> pairs = largest_eigenpairs(operation, 20, false, Crowded::LeaveOut);
  ASSERT_GE(pairs.size(), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(pairs[k].value.real(), 5 - k, 1e-13);
}

// A cyclic shift by one place. Its eigenvalues lie on a circle, and none converges before the space is complete.
TEST(LargestEigenpairs, SaysWhenItFindsNone) {
  const int rows = 1001;
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(rows, rows);
  for (int i = 0; i < rows; ++i) middle(i, (i + 1) % rows) = 1;
  EXPECT_EQ(test::refusal<std::runtime_error>([&] { largest_eigenpairs(Reflected(middle), 4, false, Crowded::Fail); }),
            "the 4 softest of 1001 eigenvalues are not found: Arnoldi's iteration does not converge");
}

TEST(KrylovSpace, IsOrthonormalAndKnowsWhatTheOperationDoes) {
  Eigen::MatrixXd middle(kRows, kRows);
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kRows; ++i) middle(i, j) = std::sin(i + 3.0 * j * j) / (1 + i + j);
  const Reflected operation(middle);
  KrylovSpace space(operation, 50 + KrylovSpace::kBlock);
  space.grow(20);
  space.grow(50);
  const Eigen::MatrixXd basis = space.basis(), coefficients = space.coefficients();
  EXPECT_LE((basis.transpose() * basis - Eigen::MatrixXd::Identity(50, 50)).norm(), 50 * 2.3e-16);
  space.grow(50 + KrylovSpace::kBlock);  // shows the vectors to which the first 50 lead
  for (int k = 0; k < 50; ++k) {
    Eigen::VectorXd image(kRows);
    operation.apply(basis.col(k).eval().data(), image.data());
    EXPECT_LE((image - space.basis() * coefficients.col(k)).norm(), 1e-15 * (1 + middle.norm())) << k;
  }
}

}  // namespace
}  // namespace flexarm
