// Tests padded vectors: against Eigen's operations, and that the fourth number stays 0.
#include "math/padded_vectors.h"

#include <gtest/gtest.h>

#include "math/so3.h"

namespace flexarm {
namespace {

/// Sums of some products of numbers of order one.
constexpr double kSumOfProducts = 1e-14;

Matrix6 full(const PaddedInertia& inertia) {
  Matrix6 out;
  out << inertia.linear.matrix(), inertia.mixed.matrix(), inertia.mixed_transposed.matrix(), inertia.rotary.matrix();
  return out;
}

PaddedInertia padded(const Matrix6& matrix) {
  const auto block = [&](int i, int j) { return PaddedMatrix3(Matrix3(matrix.block<3, 3>(i, j))); };
  return {block(0, 0), block(0, 3), block(3, 0), block(3, 3)};
}

TEST(PaddedVectors, MultiplyAsEigensDo) {
  std::srand(1);
  const Vector3 a = Vector3::Random(), b = Vector3::Random();
  const Matrix3 m = Matrix3::Random(), n = Matrix3::Random();
  const Padded3 pa(a), pb(b);
  const PaddedMatrix3 pm(m), pn(n);
  const Padded3 crossed = cross(pa, pb);
  EXPECT_LT((crossed.vector() - a.cross(b)).norm(), kSumOfProducts);
  EXPECT_EQ(crossed[3], 0);
  EXPECT_NEAR(sum(pa.values * pb.values), a.dot(b), kSumOfProducts);
  EXPECT_LT(((pm * pa).vector() - m * a).norm(), kSumOfProducts);
  EXPECT_EQ((pm * pa)[3], 0);
  EXPECT_LT(((pm * pn).matrix() - m * n).norm(), kSumOfProducts);
  EXPECT_LT((times_transposed(pm, pn).matrix() - m * n.transpose()).norm(), kSumOfProducts);
  EXPECT_LT((cross(pa, pm).matrix() - so3::hat(a) * m).norm(), kSumOfProducts);
  EXPECT_LT((times_hat(pm, pa).matrix() - m * so3::hat(a)).norm(), kSumOfProducts);
}

TEST(PaddedVectors, MoveInertiasByCongruence) {
  std::srand(2);
  Matrix6 inertia = Matrix6::Random();
  inertia = Matrix6(inertia + inertia.transpose());
  const Vector6 motion = Vector6::Random();
  const Vector3 way = Vector3::Random();
  EXPECT_LT(((padded(inertia) * PaddedSpatial(motion)).vector() - inertia * motion).norm(), kSumOfProducts);
  EXPECT_NEAR(dot(PaddedSpatial(motion), PaddedSpatial(motion)), motion.squaredNorm(), kSumOfProducts);
  Matrix6 shift = Matrix6::Identity();  // {v, w} there, by those here
  shift.topRightCorner<3, 3>() = -so3::hat(way);
  EXPECT_LT((full(padded(inertia).moved(Padded3(way))) - shift.transpose() * inertia * shift).norm(),
            4 * kSumOfProducts);
  PaddedInertia less = padded(inertia);
  less.subtract_outer(2 * PaddedSpatial(motion), PaddedSpatial(motion));
  EXPECT_LT((full(less) - (inertia - 2 * motion * motion.transpose())).norm(), kSumOfProducts);
}

}  // namespace
}  // namespace flexarm
