/// Tests properties that only tangent-scaled rotations have. The properties of all parametrisations are in
/// rotation_test.cpp.

#include "math/cayley.h"

#include <gtest/gtest.h>

#include "rotation_samples.h"

namespace flexarm::test {
namespace {

TEST(Cayley, IsTheRationalFunctionOfTheSkewMatrix) {
  Samples samples;
  for (const double length : {0.0, 1e-12, 1e-3, 0.5, 2.0, 10.0}) {
    const Vector w = samples.of_length(length);
    const LongMatrix half = 0.5L * so3::hat(w.cast<long double>()), identity = LongMatrix::Identity();
    EXPECT_LT(distance(cayley::rotation(w), LongMatrix((identity - half).inverse() * (identity + half))), roundoff);
  }
}

TEST(Cayley, HalfQuaternionTwiceIsTheQuaternion) {
  Samples samples;
  for (const double length : {0.0, 1e-12, 1e-3, 0.5, 2.0, 10.0}) {
    const Vector w = samples.of_length(length);
    const auto half = cayley::half_quaternion(w);
    EXPECT_LT(((half * half).coeffs() - cayley::quaternion(w).coeffs()).norm(), roundoff);
  }
}

TEST(Cayley, AxialStretchMakesTheHalfTurn) {
  Samples samples;
  for (const double length : {0.0, 1e-12, 1e-3, 0.5, 2.0, 10.0}) {
    const Vector w = samples.of_length(length);
    const double cosine = 1 / std::sqrt(1 + 0.25 * w.squaredNorm());
    const Matrix turn = cosine * (Matrix::Identity() + 0.5 * so3::hat(w)), stretch = cayley::axial_stretch(w);
    EXPECT_LT(distance(Matrix(stretch * cayley::half_quaternion(w).toRotationMatrix()), turn), roundoff);
    EXPECT_LT(distance(Matrix(stretch * cayley::inverse_axial_stretch(w)), Matrix(Matrix::Identity())),
              roundoff / cosine);
  }
}

TEST(Cayley, CompoundComposesRotations) {
  Samples samples;
  for (int i = 0; i < 50; ++i) {
    const Vector w1 = samples.vector(), w2 = samples.vector();
    const double kappa = 1 / (1 - 0.25 * w1.dot(w2));
    const Vector w21 = cayley::compound(w2, w1);
    const double tolerance = roundoff * std::max(1.0, std::abs(kappa));
    EXPECT_LT(distance(cayley::rotation(w21), cayley::rotation(w2) * cayley::rotation(w1)), tolerance);
    // The two one-sided formulas of the compound.
    const double scaled = tolerance * (1 + w1.squaredNorm()) * (1 + w2.squaredNorm());
    EXPECT_LT(distance(w2 + kappa * cayley::inverse_tangent(w2).transpose() * w1, w21), scaled);
    EXPECT_LT(distance(w1 + kappa * cayley::inverse_tangent(w1) * w2, w21), scaled);
  }
}

TEST(Cayley, IncrementBetweenQuaternionsIsSpatial) {
  Samples samples;
  for (int i = 0; i < 20; ++i) {
    const Vector w = samples.vector();
    const QuaternionT<double> from = so3::exp_quaternion(samples.vector());
    QuaternionT<double> to = cayley::quaternion(w) * from;
    EXPECT_LT(distance(cayley::increment(from, to), w), roundoff * (1 + w.squaredNorm()));
    to.coeffs() *= -1;
    EXPECT_LT(distance(cayley::increment(from, to), w), roundoff * (1 + w.squaredNorm()));
  }
}

/// Delta(Lambda V) = w x average(Lambda V): this identity makes the energy-momentum schemes exact.
TEST(Cayley, MidStepIdentity) {
  Samples samples;
  for (int i = 0; i < 20; ++i) {
    const Vector w = samples.vector();
    const Matrix before = so3::exp(samples.vector()), after = cayley::rotation(w) * before;
    const Matrix average = 0.5 * (before + after);
    EXPECT_LT(distance(after - before, so3::hat(w) * average), roundoff * (1 + w.norm()));
  }
}

TEST(Cayley, ScalingDerivative) {
  Samples samples;
  for (const double angle : angles_to_pi()) {
    const double conditioning = 1 / std::cos(0.5 * angle);  // condition of w, which contains 1/q_0
    for (const Vector& axis : samples.directions()) {
      SCOPED_TRACE(::testing::Message() << "angle " << angle << ", axis " << axis.transpose());
      const Vector theta = angle * axis, w = cayley::from_rotation_vector(theta), d = samples.of_length(1.0);
      const Matrix u = cayley::scaling_derivative(w), inverse = cayley::inverse_scaling_derivative(w);
      const Vector rate = derivative(cayley::from_rotation_vector(perturbed(theta, d)));
      EXPECT_LT(distance(u * d, rate), roundoff * size(u) * conditioning);
      EXPECT_LT(distance(inverse * d, derivative(cayley::to_rotation_vector(perturbed(w, d)))),
                roundoff * size(inverse));
      if (angle == 0) continue;
      const double half = 0.5 * w.norm();
      const Matrix along = axis * axis.transpose();
      const Matrix closed_form = (1 + half * half) * along + half / std::atan(half) * (Matrix::Identity() - along);
      EXPECT_LT(distance(u, closed_form), roundoff * size(u));
      const Matrix inverse_form = 1 / (1 + half * half) * along + std::atan(half) / half * (Matrix::Identity() - along);
      EXPECT_LT(distance(inverse, inverse_form), roundoff * size(inverse));
    }
  }
}

}  // namespace
}  // namespace flexarm::test
