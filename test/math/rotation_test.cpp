/// Tests properties that every parametrisation of rotations must have.

#include <gtest/gtest.h>

#include "parametrisations.h"

namespace flexarm::test {
namespace {

template <typename Parametrisation>
class RotationTest : public ::testing::Test {
 protected:
  static constexpr int components = Parametrisation::components;
  using Coordinates = Eigen::Matrix<double, components, 1>;

  /// Calls check(v, angle, axis) for many angles and axes. v is the rounded vector of this angle and axis.
  template <typename Check>
  void for_each_vector(const Check& check) {
    for (const double angle : angles_to_two_pi()) {
      if (angle > Parametrisation::largest_angle) continue;
      for (const Vector& axis : samples_.directions()) {
        SCOPED_TRACE(::testing::Message() << "angle " << angle << ", axis " << axis.transpose());
        check(make(axis, angle), angle, axis);
      }
    }
  }

  /// Calls check(v2, angle2, v1, angle1) for pairs of rotations about unrelated axes.
  template <typename Check>
  void for_each_pair(const Check& check) {
    const std::vector<double> angles = {0.0, 1e-9, 1e-3, 1.0, 2.5, pi - 1e-3, pi - 1e-9, pi, 4.0, 2 * pi - 1e-3};
    for (const double angle2 : angles) {
      for (const double angle1 : angles) {
        if (std::max(angle2, angle1) > Parametrisation::largest_angle) continue;
        for (int i = 0; i < 5; ++i) {
          SCOPED_TRACE(::testing::Message() << "angles " << angle2 << " after " << angle1);
          check(make(samples_.of_length(1.0), angle2), angle2, make(samples_.of_length(1.0), angle1), angle1);
        }
      }
    }
  }

  static Coordinates make(const Vector& axis, double angle) {
    return Parametrisation::template make<long double>(axis.cast<long double>(), angle).template cast<double>();
  }

  Samples samples_;
};

using Parametrisations = ::testing::Types<RotationVector, TangentScaled, Conformal, UnitQuaternion>;
TYPED_TEST_SUITE(RotationTest, Parametrisations);

TYPED_TEST(RotationTest, RotationAndQuaternionAgreeWithThePowerSeries) {
  this->for_each_vector([](const auto& v, double angle, const Vector& axis) {
    const LongMatrix expected = power_series(angle * axis, 0);
    // The vector is rounded: its relative error, times the angle, is an error of the matrix.
    const double tolerance = roundoff * std::max(1.0, angle);
    EXPECT_LT(distance(TypeParam::rotation(v), expected), tolerance);
    const QuaternionT<double> q = TypeParam::quaternion(v);
    EXPECT_LT(std::abs(q.norm() - 1), roundoff);
    EXPECT_LT(distance(q.toRotationMatrix(), expected), tolerance);
  });
}

TYPED_TEST(RotationTest, ConversionsAgreeWithTheDefinition) {
  this->for_each_vector([](const auto& v, double angle, const Vector& axis) {
    const Vector theta = angle * axis;
    const double tolerance = roundoff * std::max(v.norm(), angle) * TypeParam::conversion_condition(angle);
    EXPECT_LE(distance(TypeParam::from_rotation_vector(theta), v), tolerance);
    // A quaternion does not distinguish theta from theta - 2 pi.
    const bool is_shorter = TypeParam::components == 4 && angle > pi;
    const Vector expected = is_shorter ? Vector((angle - 2 * pi) * axis) : theta;
    EXPECT_LE(distance(TypeParam::to_rotation_vector(v), expected), roundoff * angle);
  });
}

TYPED_TEST(RotationTest, VectorComesBackFromTheQuaternion) {
  this->for_each_vector([](const auto& v, double angle, const Vector&) {
    if (angle >= pi) return;
    const double tolerance = roundoff * v.norm() * TypeParam::conversion_condition(angle);
    QuaternionT<double> q = TypeParam::quaternion(v);
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
    q.coeffs() *= -1;
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
    q = so3::quaternion_from_matrix(TypeParam::rotation(v));
    EXPECT_LE(distance(TypeParam::from_quaternion(q), v), tolerance);
  });
}

TYPED_TEST(RotationTest, TangentMapsTheVectorsChangeToTheSpin) {
  this->for_each_vector([this](const auto& v, double, const Vector&) {
    const auto d = this->samples_.template direction<TypeParam::components>();
    const Matrix change = derivative(TypeParam::rotation(perturbed(v, d)));
    const Matrix spin = change * TypeParam::rotation(v).transpose();
    EXPECT_LT(distance(TypeParam::tangent(v) * d, so3::vee(spin)), roundoff * size(TypeParam::tangent(v)));
  });
}

TYPED_TEST(RotationTest, InverseTangentMapsTheSpinToTheVectorsChange) {
  this->for_each_vector([this](const auto& v, double angle, const Vector&) {
    if (angle >= pi) return;
    const Vector spin = this->samples_.of_length(1.0);
    const ComplexMatrix rotation = spun(TypeParam::rotation(v), spin);
    const auto inverse = TypeParam::inverse_tangent(v);
    EXPECT_LT(distance(inverse * spin, derivative(TypeParam::from_quaternion(so3::quaternion_from_matrix(rotation)))),
              4 * roundoff * size(inverse) * TypeParam::conversion_condition(angle));
  });
}

TYPED_TEST(RotationTest, IdentitiesOfTheTangent) {
  this->for_each_vector([](const auto& v, double angle, const Vector&) {
    const Matrix identity = Matrix::Identity(), rotation = TypeParam::rotation(v);
    const auto tangent = TypeParam::tangent(v);
    const auto inverse = TypeParam::inverse_tangent(v);
    const double tolerance = roundoff * size(tangent) * size(inverse) * TypeParam::inverse_condition(angle);
    EXPECT_LT(distance(tangent * inverse, identity), tolerance);
    if constexpr (TypeParam::components == 3) {
      // The angle of Lambda is rounded.
      const double turn = std::max(1.0, angle);
      EXPECT_LT(distance(tangent * inverse.transpose(), rotation), tolerance * turn);
      EXPECT_LT(distance(rotation * tangent.transpose(), tangent), roundoff * size(tangent) * turn);
      EXPECT_LT(distance(rotation * tangent * rotation.transpose(), tangent), roundoff * size(tangent) * turn);
      EXPECT_LT(distance(identity + tangent * so3::hat(v), rotation),
                roundoff * std::max(turn, size(tangent) * v.norm()));
    }
  });
}

TYPED_TEST(RotationTest, DerivativesOfTheTangents) {
  this->for_each_vector([this](const auto& v, double angle, const Vector&) {
    const auto d = this->samples_.template direction<TypeParam::components>();
    const auto a = this->samples_.template direction<TypeParam::components>();
    const Vector b = this->samples_.of_length(1.0);
    const auto moved = perturbed(v, d);
    const auto tangent_rate = derivative(TypeParam::tangent(moved));
    const auto inverse_rate = derivative(TypeParam::inverse_tangent(moved));
    const auto xi = TypeParam::xi_tangent(v, a);
    const auto xi_transposed = TypeParam::xi_tangent_transposed(v, b);
    const auto xi_inverse = TypeParam::xi_inverse_tangent(v, b);
    const double tolerance = roundoff * std::max({size(xi), size(xi_transposed), size(tangent_rate)});
    const double inverse_tolerance =
        4 * roundoff * std::max(size(xi_inverse), size(inverse_rate)) * TypeParam::inverse_condition(angle);
    EXPECT_LT(distance(TypeParam::tangent_derivative(v, d), tangent_rate), tolerance);
    EXPECT_LT(distance(xi * d, tangent_rate * a), tolerance);
    EXPECT_LT(distance(xi_transposed * d, tangent_rate.transpose() * b), tolerance);
    EXPECT_LT(distance(TypeParam::inverse_tangent_derivative(v, d), inverse_rate), inverse_tolerance);
    EXPECT_LT(distance(xi_inverse * d, inverse_rate * b), inverse_tolerance);
  });
}

/// Compares the value of each operator in double with its value in long double for the same arguments: they differ only
/// by round-off.
TYPED_TEST(RotationTest, OperatorsAgreeWithLongDouble) {
  this->for_each_vector([this](const auto& v, double angle, const Vector&) {
    const auto d = this->samples_.template direction<TypeParam::components>();
    const Vector b = this->samples_.of_length(1.0);
    const auto long_v = v.template cast<long double>().eval();
    const auto long_d = d.template cast<long double>().eval();
    const LongVector long_b = b.cast<long double>();
    const auto expect_near = [](const auto& value, const auto& exact, double tolerance) {
      EXPECT_LE(distance(value, exact), tolerance * std::max(size(exact), TypeParam::term_size));
    };
    const double inverse_roundoff = 4 * roundoff * TypeParam::inverse_condition(angle);
    expect_near(TypeParam::rotation(v), TypeParam::rotation(long_v), roundoff);
    expect_near(TypeParam::quaternion(v).coeffs(), TypeParam::quaternion(long_v).coeffs(), roundoff);
    expect_near(TypeParam::to_rotation_vector(v), TypeParam::to_rotation_vector(long_v), roundoff);
    expect_near(TypeParam::tangent(v), TypeParam::tangent(long_v), roundoff);
    expect_near(TypeParam::inverse_tangent(v), TypeParam::inverse_tangent(long_v), inverse_roundoff);
    expect_near(TypeParam::tangent_derivative(v, d), TypeParam::tangent_derivative(long_v, long_d), roundoff);
    expect_near(TypeParam::inverse_tangent_derivative(v, d), TypeParam::inverse_tangent_derivative(long_v, long_d),
                inverse_roundoff);
    expect_near(TypeParam::xi_tangent(v, d), TypeParam::xi_tangent(long_v, long_d), roundoff);
    expect_near(TypeParam::xi_tangent_transposed(v, b), TypeParam::xi_tangent_transposed(long_v, long_b), roundoff);
    expect_near(TypeParam::xi_inverse_tangent(v, b), TypeParam::xi_inverse_tangent(long_v, long_b), inverse_roundoff);
  });
}

TYPED_TEST(RotationTest, CompoundComposesRotations) {
  this->for_each_pair([](const auto& v2, double angle2, const auto& v1, double angle1) {
    // Even if the compound vector is large, it is a quotient of quaternion components with errors of some epsilon.
    EXPECT_LT(
        distance(TypeParam::rotation(TypeParam::compound(v2, v1)), TypeParam::rotation(v2) * TypeParam::rotation(v1)),
        roundoff * std::max(1.0, angle2 + angle1));
  });
}

TYPED_TEST(RotationTest, CompoundCarriesTheSpin) {
  this->for_each_pair([this](const auto& v2, double angle2, const auto& v1, double) {
    // d(Lambda_2 Lambda_1) has the spin of d(Lambda_2) if Lambda_1 is constant.
    const auto d = this->samples_.template direction<TypeParam::components>();
    const auto rate = derivative(TypeParam::compound(perturbed(v2, d), v1.template cast<Complex>().eval()));
    const auto v21 = TypeParam::compound(v2, v1);
    const auto tangent = TypeParam::tangent(v21);
    const QuaternionT<double> q = TypeParam::quaternion(v21);
    const double angle21 = 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
    // Towards the singular angle, the rate is a small difference of terms that are larger by the condition number.
    const double condition = TypeParam::conversion_condition(angle21) * TypeParam::conversion_condition(angle2);
    const double scale = std::max(size(tangent) * size(rate), TypeParam::term_size);
    EXPECT_LE(distance(tangent * rate, TypeParam::tangent(v2) * d), 4 * roundoff * scale * condition);
  });
}

}  // namespace
}  // namespace flexarm::test
