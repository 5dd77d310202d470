/// Tests properties that only conformal rotation vectors have. The properties of all parametrisations are in
/// rotation_test.cpp.

#include "math/conformal.h"

#include <gtest/gtest.h>

#include "rotation_samples.h"

namespace flexarm::test {
namespace {

/// Returns the conformal vector by its definition.
Vector conformal_vector(const Vector& axis, double angle) {
  return 4 * std::tan(0.25 * angle) * axis;
}

TEST(Conformal, TangentIsAMultipleOfTheHalfRotation) {
  Samples samples;
  for (const double angle : angles_to_two_pi()) {
    const Vector axis = samples.of_length(1.0), c = conformal_vector(axis, angle);
    const double scale = std::pow(std::cos(0.25 * angle), 2);
    const Matrix tangent = conformal::tangent(c);
    // scale = 1 / (1 + c.c/16) depends on c with the same condition as the tangent.
    EXPECT_LT(distance(tangent, scale * power_series(0.5 * angle * axis, 0)),
              roundoff * scale / std::cos(0.25 * angle));
    EXPECT_LT(distance(tangent, cayley::rotation(Vector(0.5 * c)) / (1 + c.squaredNorm() / 16)),
              roundoff * size(tangent));
  }
}

TEST(Conformal, HalfRotationTwiceIsTheRotation) {
  Samples samples;
  for (const double angle : angles_to_two_pi()) {
    const Vector c = conformal_vector(samples.of_length(1.0), angle);
    const Matrix half = cayley::rotation(Vector(0.5 * c));
    EXPECT_LT(distance(half * half, conformal::rotation(c)), roundoff);
  }
}

TEST(Conformal, ShadowIsTheSameRotation) {
  Samples samples;
  for (const double angle : angles_to_two_pi()) {
    if (angle == 0) continue;
    const Vector c = conformal_vector(samples.of_length(1.0), angle), shadow = conformal::shadow(c);
    EXPECT_LT(distance(conformal::rotation(shadow), conformal::rotation(c)), roundoff);
    EXPECT_LT((conformal::quaternion(shadow).coeffs() + conformal::quaternion(c).coeffs()).norm(), roundoff);
    EXPECT_NEAR(shadow.norm() * c.norm(), 16, 16 * roundoff);
    EXPECT_LT(distance(conformal::shadow(shadow), c), roundoff * c.norm());
    // The quaternion gives the shorter of the two vectors. At exactly pi, both vectors have length 4.
    if (std::abs(angle - pi) < 1e-12) continue;
    EXPECT_LT(distance(conformal::from_quaternion(conformal::quaternion(c)), angle < pi ? c : shadow), 4 * roundoff);
  }
}

TEST(Conformal, QuaternionsOfAnyNormAndSignGiveTheSameVector) {
  Samples samples;
  for (const double angle : angles_to_pi()) {
    const Vector c = conformal_vector(samples.of_length(1.0), angle);
    for (const double factor : {-1.0, 2.0, -1e-3, 1e3}) {
      QuaternionT<double> q = conformal::quaternion(c);
      q.coeffs() *= factor;
      EXPECT_LE(distance(conformal::from_quaternion(q), c), roundoff * c.norm());
    }
  }
}

TEST(Conformal, CompoundSwitchesToTheShadowBeyondPi) {
  const Vector axis = Samples().of_length(1.0);
  for (const double angle2 : angles_to_two_pi()) {
    for (const double angle1 : angles_to_two_pi()) {
      SCOPED_TRACE(::testing::Message() << "angles " << angle2 << " after " << angle1);
      // The sum of two angles about one axis, reduced to the interval from -pi to pi.
      const double angle = std::remainder(static_cast<double>(angle2) + angle1, 2 * pi);
      const Vector c21 = conformal::compound(conformal_vector(axis, angle2), conformal_vector(axis, angle1));
      EXPECT_LE(c21.norm(), 4 * (1 + roundoff));
      const double tolerance = 2 * roundoff * (1 + angle2 + angle1);  // d(c)/d(angle) is at most 2
      if (pi - std::abs(angle) < tolerance) continue;                 // either of two opposite vectors is correct
      EXPECT_LE(distance(c21, conformal_vector(axis, angle)), tolerance);
    }
  }
}

TEST(Conformal, CompoundOfQuarterTurnsIsAHalfTurn) {
  const Vector quarter = conformal_vector(Vector::UnitZ(), 0.5 * pi);
  const Vector half = conformal::compound(quarter, quarter);
  EXPECT_NEAR(std::abs(half[2]), 4, 4 * roundoff);
  EXPECT_LT(half.head<2>().norm(), roundoff);
  EXPECT_LT(conformal::compound(half, half).norm(), 4 * roundoff);
}

TEST(Conformal, ManyCompoundsStayBounded) {
  Samples samples;
  Vector c = Vector::Zero();
  Matrix rotation = Matrix::Identity();
  constexpr int turns = 1000;
  for (int i = 0; i < turns; ++i) {
    const Vector increment = samples.vector();
    c = conformal::compound(increment, c);
    rotation = conformal::rotation(increment) * rotation;
    ASSERT_LE(c.norm(), 4 * (1 + roundoff));
  }
  EXPECT_LT(distance(conformal::rotation(c), rotation), turns * roundoff);
}

}  // namespace
}  // namespace flexarm::test
