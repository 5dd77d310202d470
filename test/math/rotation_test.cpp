/// What every parametrisation of rotations must satisfy, whatever its vector means.

#include <gtest/gtest.h>

#include <flexarm/math/cayley.h>
#include <flexarm/math/so3.h>

#include "rotation_samples.h"

namespace flexarm::test {
namespace {

struct RotationVector {
  static constexpr double largest_angle = 6.0;
  /// T is singular at 2 pi, like sin^2(angle/2): 1/det T multiplies the round-off of what is made of T^-1.
  static double conditioning(double angle) { return angle < pi ? 1 : 1 / std::pow(std::sin(0.5 * angle), 2); }
  /// Vector of a rotation about a unit axis.
  static Vector make(const Vector& axis, double angle) { return angle * axis; }
  template <typename S>
  static Vector3T<S> from_quaternion(const QuaternionT<S>& q) {
    return so3::log(q);
  }
  template <typename S>
  static Matrix3T<S> rotation(const Vector3T<S>& v) {
    return so3::exp(v);
  }
  template <typename S>
  static QuaternionT<S> quaternion(const Vector3T<S>& v) {
    return so3::exp_quaternion(v);
  }
  template <typename S>
  static Matrix3T<S> tangent(const Vector3T<S>& v) {
    return so3::tangent(v);
  }
  template <typename S>
  static Matrix3T<S> inverse_tangent(const Vector3T<S>& v) {
    return so3::inverse_tangent(v);
  }
  static Matrix tangent_derivative(const Vector& v, const Vector& d) { return so3::tangent_derivative(v, d); }
  static Matrix inverse_tangent_derivative(const Vector& v, const Vector& d) {
    return so3::inverse_tangent_derivative(v, d);
  }
  static Matrix xi_tangent(const Vector& v, const Vector& a) { return so3::xi_tangent(v, a); }
  static Matrix xi_inverse_tangent(const Vector& v, const Vector& a) { return so3::xi_inverse_tangent(v, a); }
};

struct TangentScaled {
  static constexpr double largest_angle = 3.1;
  /// The vector is 2 q_v/q_0 with q_0 = cos(angle/2), S contains q_0^2: both lose digits towards pi.
  static double conditioning(double angle) { return 1 / std::pow(std::cos(0.5 * angle), 2); }
  static Vector make(const Vector& axis, double angle) { return 2 * std::tan(0.5 * angle) * axis; }
  template <typename S>
  static Vector3T<S> from_quaternion(const QuaternionT<S>& q) {
    return cayley::increment(q);
  }
  template <typename S>
  static Matrix3T<S> rotation(const Vector3T<S>& v) {
    return cayley::rotation(v);
  }
  template <typename S>
  static QuaternionT<S> quaternion(const Vector3T<S>& v) {
    return cayley::quaternion(v);
  }
  template <typename S>
  static Matrix3T<S> tangent(const Vector3T<S>& v) {
    return cayley::tangent(v);
  }
  template <typename S>
  static Matrix3T<S> inverse_tangent(const Vector3T<S>& v) {
    return cayley::inverse_tangent(v);
  }
  static Matrix tangent_derivative(const Vector& v, const Vector& d) { return cayley::tangent_derivative(v, d); }
  static Matrix inverse_tangent_derivative(const Vector& v, const Vector& d) {
    return cayley::inverse_tangent_derivative(v, d);
  }
  static Matrix xi_tangent(const Vector& v, const Vector& a) { return cayley::xi_tangent(v, a); }
  static Matrix xi_inverse_tangent(const Vector& v, const Vector& a) { return cayley::xi_inverse_tangent(v, a); }
};

template <typename Parametrisation>
class RotationTest : public ::testing::Test {
 protected:
  /// Calls check(v, angle, axis) over angles and axes.
  template <typename Check>
  void for_each_vector(const Check& check) {
    for (const double angle : angles_to_two_pi()) {
      if (angle > Parametrisation::largest_angle) continue;
      for (const Vector& axis : samples_.directions()) {
        SCOPED_TRACE(::testing::Message() << "angle " << angle << ", axis " << axis.transpose());
        check(Parametrisation::make(axis, angle), angle, axis);
      }
    }
  }
  Samples samples_;
};

using Parametrisations = ::testing::Types<RotationVector, TangentScaled>;
TYPED_TEST_SUITE(RotationTest, Parametrisations);

/// Entries of the operators are sums of a handful of products: 16 roundings bound them, relative to the largest entry.
constexpr double roundoff = 16 * epsilon;

TYPED_TEST(RotationTest, RotationAndQuaternionAgreeWithThePowerSeries) {
  this->for_each_vector([](const Vector& v, double angle, const Vector& axis) {
    const LongMatrix expected = power_series(angle * axis, 0);
    // The angle itself is rounded (once, and once more in tan): its error turns the matrix by as much.
    const double tolerance = roundoff * std::max(1.0, angle);
    EXPECT_LT(distance(TypeParam::rotation(v), expected), tolerance);
    const QuaternionT<double> q = TypeParam::quaternion(v);
    EXPECT_LT(std::abs(q.norm() - 1), roundoff);
    EXPECT_LT(distance(q.toRotationMatrix(), expected), tolerance);
  });
}

TYPED_TEST(RotationTest, VectorComesBackFromTheQuaternion) {
  this->for_each_vector([](const Vector& v, double angle, const Vector&) {
    if (angle >= pi) return;
    const double tolerance = roundoff * v.norm() * TypeParam::conditioning(angle);
    QuaternionT<double> q = TypeParam::quaternion(v);
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
    q.coeffs() *= -1;
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
    q = so3::quaternion_from_matrix(TypeParam::rotation(v));
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
  });
}

TYPED_TEST(RotationTest, TangentMapsTheVectorsChangeToTheSpin) {
  this->for_each_vector([this](const Vector& v, double, const Vector&) {
    const Vector d = this->samples_.of_length(1.0);
    const Matrix change = derivative(TypeParam::rotation(perturbed(v, d)));
    const Matrix spin = change * TypeParam::rotation(v).transpose();
    EXPECT_LT(distance(TypeParam::tangent(v) * d, so3::vee(spin)), roundoff);
  });
}

TYPED_TEST(RotationTest, InverseTangentMapsTheSpinToTheVectorsChange) {
  this->for_each_vector([this](const Vector& v, double angle, const Vector&) {
    if (angle >= pi) return;
    const Vector spin = this->samples_.of_length(1.0);
    const ComplexMatrix rotation = spun(TypeParam::rotation(v), spin);
    const ComplexVector changed = TypeParam::from_quaternion(so3::quaternion_from_matrix(rotation));
    const Matrix inverse = TypeParam::inverse_tangent(v);
    EXPECT_LT(distance(inverse * spin, derivative(changed)),
              4 * roundoff * size(inverse) * TypeParam::conditioning(angle));
  });
}

TYPED_TEST(RotationTest, IdentitiesOfTheTangent) {
  this->for_each_vector([](const Vector& v, double angle, const Vector&) {
    const Matrix identity = Matrix::Identity();
    const Matrix rotation = TypeParam::rotation(v), tangent = TypeParam::tangent(v);
    const Matrix inverse = TypeParam::inverse_tangent(v);
    // Lambda is rounded in its angle.
    const double tolerance = roundoff * std::max(1.0, angle);
    EXPECT_LT(distance(tangent * inverse, identity), tolerance * size(inverse) * TypeParam::conditioning(angle));
    EXPECT_LT(distance(tangent * inverse.transpose(), rotation),
              tolerance * size(inverse) * TypeParam::conditioning(angle));
    EXPECT_LT(distance(rotation * tangent.transpose(), tangent), tolerance);
    EXPECT_LT(distance(rotation * tangent * rotation.transpose(), tangent), tolerance);
    EXPECT_LT(distance(identity + tangent * so3::hat(v), rotation), tolerance * std::max(1.0, v.norm()));
  });
}

TYPED_TEST(RotationTest, DerivativesOfTheTangents) {
  this->for_each_vector([this](const Vector& v, double angle, const Vector&) {
    const Vector d = this->samples_.of_length(1.0), a = this->samples_.of_length(1.0);
    const ComplexVector moved = perturbed(v, d);
    const Matrix tangent_rate = derivative(TypeParam::tangent(moved));
    const Matrix inverse_rate = derivative(TypeParam::inverse_tangent(moved));
    const double tolerance = roundoff * std::max(1.0, size(tangent_rate));
    const double inverse_tolerance = 4 * roundoff * std::max(1.0, size(inverse_rate)) * TypeParam::conditioning(angle);
    EXPECT_LT(distance(TypeParam::tangent_derivative(v, d), tangent_rate), tolerance);
    EXPECT_LT(distance(TypeParam::xi_tangent(v, a) * d, tangent_rate * a), tolerance);
    EXPECT_LT(distance(TypeParam::inverse_tangent_derivative(v, d), inverse_rate), inverse_tolerance);
    EXPECT_LT(distance(TypeParam::xi_inverse_tangent(v, a) * d, inverse_rate * a), inverse_tolerance);
  });
}

}  // namespace
}  // namespace flexarm::test
