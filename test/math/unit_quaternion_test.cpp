/// Tests properties that only unit quaternions have as rotation parameters. The properties of all parametrisations are
/// in rotation_test.cpp.

#include "math/unit_quaternion.h"

#include <gtest/gtest.h>

#include "rotation_samples.h"

namespace flexarm::test {
namespace {

using Vector4 = unit_quaternion::Vector4T<double>;
using Matrix4 = unit_quaternion::Matrix4T<double>;
using Matrix34 = unit_quaternion::Matrix34T<double>;

constexpr int repetitions = 50;

TEST(UnitQuaternion, ProductAndConjugateAreThoseOfEigen) {
  Samples samples;
  for (int i = 0; i < repetitions; ++i) {
    const Vector4 q2 = samples.direction<4>(), q1 = samples.direction<4>();
    const QuaternionT<double> product = unit_quaternion::quaternion(q2) * unit_quaternion::quaternion(q1);
    EXPECT_LT(distance(unit_quaternion::compound(q2, q1), unit_quaternion::from_quaternion(product)), roundoff);
    EXPECT_EQ(unit_quaternion::conjugate(q1),
              unit_quaternion::from_quaternion(unit_quaternion::quaternion(q1).conjugate()));
    EXPECT_LT(distance(unit_quaternion::compound(q1, unit_quaternion::conjugate(q1)), Vector4::UnitX()), roundoff);
    EXPECT_LT(distance(unit_quaternion::rotation(q1), unit_quaternion::quaternion(q1).toRotationMatrix()), roundoff);
    EXPECT_EQ(unit_quaternion::rotation(Vector4(-q1)), unit_quaternion::rotation(q1));
  }
}

TEST(UnitQuaternion, IdentitiesOfTheSpinOperators) {
  Samples samples;
  for (int i = 0; i < repetitions; ++i) {
    const Vector4 q = samples.direction<4>();
    const Matrix rotation = unit_quaternion::rotation(q);
    const Matrix34 tangent = unit_quaternion::tangent(q), material = unit_quaternion::material_tangent(q);
    EXPECT_LT((tangent * q).norm(), roundoff);
    EXPECT_LT((material * q).norm(), roundoff);
    EXPECT_LT(distance(0.25 * tangent * tangent.transpose(), Matrix::Identity()), roundoff);
    EXPECT_LT(distance(unit_quaternion::inverse_tangent(q) * tangent, Matrix4::Identity() - q * q.transpose()),
              roundoff);
    EXPECT_LT(distance(0.25 * tangent * material.transpose(), rotation), roundoff);
    EXPECT_LT(distance(rotation.transpose() * tangent, material), 2 * roundoff);
    // dq = 1/2 (0, spin) q is tangent to the sphere.
    const Vector spin = samples.of_length(1.0);
    const Vector4 rate = unit_quaternion::inverse_tangent(q) * spin;
    Vector4 pure;
    pure << 0, spin;
    EXPECT_LT(distance(rate, 0.5 * unit_quaternion::compound(pure, q)), roundoff);
    EXPECT_LT(std::abs(q.dot(rate)), roundoff);
  }
}

TEST(UnitQuaternion, DerivativesOfTheRotatedVector) {
  Samples samples;
  for (int i = 0; i < repetitions; ++i) {
    // The norm and the direction of change are arbitrary: the derivatives are those of the polynomial.
    const Vector4 q = 1.3 * samples.direction<4>(), d = samples.direction<4>();
    const Vector a = samples.of_length(1.0);
    const Matrix rate = derivative(unit_quaternion::rotation(perturbed(q, d)));
    EXPECT_LT(distance(unit_quaternion::xi_rotation(q, a) * d, rate * a), 2 * roundoff);
    EXPECT_LT(distance(unit_quaternion::xi_rotation_transposed(q, a) * d, rate.transpose() * a), 2 * roundoff);
  }
}

TEST(UnitQuaternion, DerivativesAlongTheSphereAreThoseOfTheSpin) {
  Samples samples;
  for (int i = 0; i < repetitions; ++i) {
    const Vector4 q = samples.direction<4>();
    const Vector a = samples.of_length(1.0), spin = samples.of_length(1.0);
    const Vector4 d = unit_quaternion::inverse_tangent(q) * spin;
    const Matrix rotation = unit_quaternion::rotation(q);
    EXPECT_LT(distance(unit_quaternion::xi_rotation(q, a) * d, spin.cross(rotation * a)), 2 * roundoff);
    EXPECT_LT(distance(unit_quaternion::xi_rotation_transposed(q, a) * d, rotation.transpose() * a.cross(spin)),
              2 * roundoff);
  }
}

TEST(UnitQuaternion, Normalisation) {
  Samples samples;
  for (const double norm : {1e-3, 0.7, 1.0, 50.0}) {
    for (int i = 0; i < repetitions; ++i) {
      const Vector4 q = norm * samples.direction<4>(), d = samples.direction<4>();
      const Vector4 unit = unit_quaternion::normalised(q);
      EXPECT_NEAR(unit.norm(), 1, roundoff);
      EXPECT_LT(distance(norm * unit, q), roundoff * norm);
      const Matrix4 slope = unit_quaternion::normalisation_derivative(q);
      EXPECT_LT(distance(slope * d, derivative(unit_quaternion::normalised(perturbed(q, d)))), roundoff / norm);
      EXPECT_LT((slope * q).norm(), roundoff);
    }
  }
}

/// Compares the curvature of an interpolated and normalised quaternion with the curvature of the rotation matrix.
TEST(UnitQuaternion, MaterialTangentGivesTheCurvature) {
  Samples samples;
  for (int i = 0; i < repetitions; ++i) {
    const Vector4 q = 0.8 * samples.direction<4>(), slope = samples.direction<4>();
    const Vector4 unit = unit_quaternion::normalised(q);
    const Vector4 unit_slope = unit_quaternion::normalisation_derivative(q) * slope;
    const Matrix rate = derivative(unit_quaternion::rotation(unit_quaternion::normalised(perturbed(q, slope))));
    const Vector curvature = so3::vee(unit_quaternion::rotation(unit).transpose() * rate);
    EXPECT_LT(distance(unit_quaternion::material_tangent(unit) * unit_slope, curvature), 2 * roundoff);
  }
}

}  // namespace
}  // namespace flexarm::test
