/// Tests rotation vectors: coefficients, the logarithm through pi, and operators that other parametrisations do not
/// have.

#include "math/so3.h"

#include <array>

#include <gtest/gtest.h>

#include "rotation_samples.h"

namespace flexarm::test {
namespace {

/// Returns a_k by its definition in long double. Terms reach (2 pi)^6/7! = 12, which limits the accuracy of the sum.
constexpr double series_error = 1e-18;
long double series(int k, long double x) {
  long double term = 1, sum = 0;
  for (int n = 2; n <= k + 1; ++n) term /= n;
  for (int j = 0; j < 40; ++j) {
    sum += term;
    term *= -x / ((2.0L * j + k + 2) * (2.0L * j + k + 3));
  }
  return sum;
}

/// Returns a running error bound of the recurrences: four roundings for each evaluation plus the propagated error.
template <int kmax>
std::array<double, kmax + 1> error_bounds(double x) {
  std::array<double, kmax + 1> bound;
  const auto value = [x](int k) { return static_cast<double>(std::abs(series(k, x))); };
  if (x < 4) {
    bound[kmax] = 4 * epsilon * value(kmax);
    bound[kmax - 1] = 4 * epsilon * value(kmax - 1);
    for (int k = kmax; k >= 2; --k) bound[k - 2] = x * bound[k] + 4 * epsilon * (value(k - 2) + x * value(k));
  } else {
    const double theta = std::sqrt(x), sine = std::abs(std::sin(theta / 2)), sine_error = epsilon * (1 + theta / 2);
    bound[0] = 2 * sine_error / theta + 4 * epsilon * value(0);
    bound[1] = 4 * sine * sine_error / x + 4 * epsilon * value(1);
    for (int k = 2; k <= kmax; ++k) bound[k] = (bound[k - 2] + 4 * epsilon * value(k - 2)) / x + 4 * epsilon * value(k);
  }
  return bound;
}

template <int kmax>
void check_coefficients(double x) {
  SCOPED_TRACE(::testing::Message() << "a_0 .. a_" << kmax << " at theta^2 = " << x);
  const std::array<double, kmax + 1> a = so3::series_coefficients<kmax>(x), bound = error_bounds<kmax>(x);
  for (int k = 0; k <= kmax; ++k) {
    EXPECT_LE(std::abs(static_cast<double>(a[k] - series(k, x))), bound[k] + series_error) << "k = " << k;
  }
}

TEST(SeriesCoefficients, AgreeWithTheirDefinitionThroughTwoPi) {
  std::vector<double> angles = angles_to_two_pi();
  for (double angle = 0.05; angle < 2 * pi; angle += 0.05) angles.push_back(angle);
  angles.push_back(2 * pi - 1e-4);
  for (const double angle : angles) {
    check_coefficients<1>(angle * angle);
    check_coefficients<4>(angle * angle);
    check_coefficients<5>(angle * angle);
    check_coefficients<6>(angle * angle);
  }
}

TEST(SeriesCoefficients, LongDoubleKeepsItsDigits) {
  for (const long double angle : {1e-12L, 0.1L, 0.99L, 1.01L, 1.99L}) {
    const std::array<long double, 6> a = so3::series_coefficients<5>(angle * angle);
    for (int k = 0; k <= 5; ++k) {
      EXPECT_LT(std::abs(a[k] / series(k, angle * angle) - 1), 16 * std::numeric_limits<long double>::epsilon());
    }
  }
}

TEST(SeriesCoefficients, RatesFollowTheFamily) {
  for (const double x : {1e-4, 0.5, 1.7, 3.9, 4.1, 9.0, 30.0}) {
    const std::array<double, 7> a = so3::series_coefficients<6>(x);
    const std::array<Complex, 7> moved = so3::series_coefficients<6>(Complex(x, complex_step));
    // d/dx = 1/(2 theta) d/d(theta), with x = theta^2.
    for (int k = 0; k <= 4; ++k) {
      EXPECT_NEAR(moved[k].imag() / complex_step, 0.5 * ((k + 1) * a[k + 2] - a[k + 1]), roundoff);
    }
  }
}

TEST(So3, HatAndVee) {
  const Vector a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_EQ(Vector(so3::hat(a) * b), a.cross(b));
  EXPECT_EQ(so3::vee(so3::hat(a)), a);
  EXPECT_EQ(so3::cross(a, b), a.cross(b));
}

TEST(So3, QuaternionFromMatrixTakesEveryPivot) {
  Samples samples;
  for (const Vector& axis : samples.directions()) {
    for (const double angle : {0.0, 1e-12, 1.0, 2.0, 2.2, 3.0, pi - 1e-9, pi}) {
      const QuaternionT<double> q = so3::quaternion_from_matrix(so3::exp(angle * axis));
      EXPECT_GE(q.w(), 0.0);
      EXPECT_LT(std::abs(q.norm() - 1), roundoff);
      EXPECT_LT(distance(q.toRotationMatrix(), power_series(angle * axis, 0)), 2 * roundoff);
    }
  }
}

TEST(So3, LogarithmIsAccurateFromZeroThroughPi) {
  Samples samples;
  std::vector<double> angles = angles_to_pi();
  for (double angle = 0.02; angle < pi; angle += 0.02) angles.push_back(angle);
  for (const double angle : angles) {
    for (const Vector& axis : samples.directions()) {
      SCOPED_TRACE(::testing::Message() << "angle " << angle << ", axis " << axis.transpose());
      const Vector theta = angle * axis;
      // The quaternion is computed in long double, so that only the logarithm is judged.
      const QuaternionT<double> q = so3::exp_quaternion(theta.cast<long double>()).cast<double>();
      EXPECT_LE(distance(so3::log(q), theta), 4 * epsilon * angle);
      EXPECT_LE(distance(so3::log(so3::exp(theta)), theta), roundoff * angle);
    }
  }
}

TEST(So3, UnfoldedLogarithmIsAccurateFromZeroToTwoPi) {
  Samples samples;
  std::vector<double> angles = angles_to_pi();
  for (double angle = 0.02; angle < 2 * pi - 0.01; angle += 0.02) angles.push_back(angle);
  for (const double angle : angles)
    for (const Vector& axis : samples.directions()) {
      const Vector theta = angle * axis;
      const QuaternionT<double> q = so3::exp_quaternion(theta.cast<long double>()).cast<double>();
      // The axis is q_v divided by its norm, which falls towards 2 pi.
      const double condition = angle < pi ? 1 : 1 / std::sin(0.5 * angle);
      EXPECT_LE(distance(so3::unfolded_log(q), theta), 4 * epsilon * angle * condition) << "angle " << angle;
      EXPECT_LE(distance(so3::unfolded_log(QuaternionT<double>(3 * q.w(), 3 * q.x(), 3 * q.y(), 3 * q.z())), theta),
                roundoff * angle * condition);
    }
}

/// Angles on both sides of pi are exact in long double, so that only the rounding of the matrix or quaternion to double
/// remains. The four components determine the rotation with condition one, so the bound does not grow towards pi.
TEST(So3, ExtractionIsAccurateOnBothSidesOfPi) {
  Samples samples;
  std::vector<Vector> axes = samples.directions();
  for (const Vector& axis : {Vector(1, 1, 1), Vector(1, 1e-4, 0), Vector(1e-8, 1, -1e-8), Vector(1, 1, -1e-12)})
    axes.push_back(axis.normalized());
  for (const Vector& direction : axes) {
    const LongVector axis = direction.cast<long double>().normalized();
    for (int exponent = 1; exponent <= 13; ++exponent) {
      for (const long double side : {-1.0L, 1.0L}) {
        SCOPED_TRACE(::testing::Message() << "pi + " << side << "e-" << exponent << ", axis " << direction.transpose());
        const long double beyond = side * std::pow(10.0L, -exponent), angle = long_pi + beyond;
        const LongMatrix exact = power_series(angle * axis, 0);
        const Matrix rotation = exact.cast<double>();
        // The quaternion with q0 >= 0 and the rotation vector of length at most pi.
        const long double sine = std::cos(0.5L * beyond), cosine = std::sin(0.5L * std::abs(beyond));
        const QuaternionT<double> q = so3::quaternion_from_matrix(rotation);
        EXPECT_LE(std::abs(static_cast<double>(q.w() - cosine)), roundoff);
        EXPECT_LE(distance(q.vec(), -side * sine * axis), roundoff);
        const LongVector theta = -side * (long_pi - std::abs(beyond)) * axis;
        EXPECT_LE(distance(so3::log(rotation), theta), roundoff * pi);
        QuaternionT<double> given;
        given.w() = static_cast<double>(-side * cosine);
        given.vec() = (sine * axis).cast<double>();
        EXPECT_LE(distance(so3::log(given), theta), roundoff * pi);
        // The terms of the power series reach pi^3/3! < 6.
        const double long_roundoff = 16 * static_cast<double>(std::numeric_limits<long double>::epsilon());
        EXPECT_LE(distance(so3::log(so3::quaternion_from_matrix(exact)), theta), 6 * long_roundoff * pi);
      }
    }
  }
}

TEST(So3, LogarithmAtPiIsOneOfTheTwo) {
  Samples samples;
  for (const Vector& axis : samples.directions()) {
    const Matrix half_turn = 2 * axis * axis.transpose() - Matrix::Identity();
    const Vector theta = so3::log(half_turn);
    EXPECT_NEAR(theta.norm(), pi, roundoff);
    EXPECT_LT(theta.cross(axis).norm(), roundoff);
    const Vector from_quaternion = so3::log(QuaternionT<double>(0, axis[0], axis[1], axis[2]));
    EXPECT_LT((from_quaternion - pi * axis).norm(), roundoff);
  }
}

TEST(So3, LogarithmIgnoresTheNormAndSignOfTheQuaternion) {
  Samples samples;
  for (const double angle : {1e-9, 0.3, 1.0, 2.5, 3.1}) {
    const Vector theta = samples.of_length(angle);
    for (const double factor : {-1.0, 2.0, 1e-3}) {
      QuaternionT<double> q = so3::exp_quaternion(theta);
      q.coeffs() *= factor;
      EXPECT_LT(distance(so3::log(q), theta), roundoff * angle);
    }
  }
}

TEST(So3, LongRotationVectorsAreThoseOfTheirRemainder) {
  const Vector axis = Samples().of_length(1.0);
  for (const double turns : {1.0, 3.0, 10.0}) {
    const double angle = 2 * pi * turns + 0.5;
    EXPECT_LT(distance(so3::exp(angle * axis), so3::exp(0.5 * axis)), epsilon * angle + roundoff);
    EXPECT_LT(distance(so3::log(so3::exp_quaternion(angle * axis)), 0.5 * axis), epsilon * angle + roundoff);
  }
}

/// Calls check(theta) for angles below 2 pi and many directions.
template <typename Check>
void for_each_rotation_vector(const Check& check) {
  Samples samples;
  for (const double angle : angles_to_two_pi()) {
    for (const Vector& axis : samples.directions()) {
      SCOPED_TRACE(::testing::Message() << "angle " << angle << ", axis " << axis.transpose());
      check(Vector(angle * axis));
    }
  }
}

TEST(So3, TangentAgreesWithThePowerSeries) {
  for_each_rotation_vector([](const Vector& theta) {
    const LongMatrix tangent = power_series(theta, 1);
    const LongMatrix inverse = tangent.inverse();
    EXPECT_LT(distance(so3::tangent(theta), tangent), roundoff);
    EXPECT_NEAR(so3::tangent(theta).determinant(), 2 * so3::series_coefficients<1>(theta.squaredNorm())[1], roundoff);
    // T^-1 contains 1/a_1, a_1 = 2 sin^2(theta/2)/theta^2. Near 2 pi, round-off in theta is magnified there.
    const double conditioning = theta.norm() < pi ? 1 : 1 / std::pow(std::sin(0.5 * theta.norm()), 2);
    EXPECT_LT(distance(so3::inverse_tangent(theta), inverse), roundoff * conditioning);
  });
}

TEST(So3, OneExponentialMapServesAllOperators) {
  Samples samples;
  for_each_rotation_vector([&samples](const Vector& theta) {
    const Vector d = samples.vector(), a = samples.vector();
    const so3::ExponentialMap<double> map(theta);
    EXPECT_EQ(map.rotation_vector(), theta);
    EXPECT_EQ(map.rotation(), so3::exp(theta));
    EXPECT_EQ(map.tangent(), so3::tangent(theta));
    EXPECT_EQ(map.inverse_tangent(), so3::inverse_tangent(theta));
    EXPECT_EQ(map.tangent_derivative(d), so3::tangent_derivative(theta, d));
    EXPECT_EQ(map.xi_tangent(a), so3::xi_tangent(theta, a));
    EXPECT_LT(distance(map.material_spin(d), map.tangent().transpose() * d), roundoff * d.norm());
  });
}

TEST(So3, IdentitiesOfTheDerivatives) {
  Samples samples;
  for_each_rotation_vector([&samples](const Vector& theta) {
    const Vector d = samples.of_length(1.0), material = samples.of_length(1.0), force = samples.of_length(1.0);
    const Matrix rotation = so3::exp(theta), tangent = so3::tangent(theta);
    const Vector spatial = rotation * material;
    const double tolerance = roundoff * std::max(1.0, theta.norm());  // the angle of the rotation is rounded
    EXPECT_LT(distance(so3::tangent_derivative(theta, d).transpose() * spatial,
                       so3::xi_tangent(theta, material).transpose() * d),
              tolerance);
    const Matrix product = -tangent.transpose() * so3::hat(spatial) * tangent;
    EXPECT_LT(distance(product + so3::xi_tangent_transposed(theta, spatial), so3::xi_tangent(theta, material)),
              tolerance);
    const Vector n = rotation * force;
    const Matrix second = tangent.transpose() * so3::hat(d) * so3::hat(n) * tangent -
                          so3::xi_tangent_transposed(theta, Vector(d.cross(n)));
    EXPECT_LT(distance(second, second.transpose()), tolerance);
  });
}

TEST(So3, SecondTangentIsTheSymmetricHessian) {
  Samples samples;
  for_each_rotation_vector([&samples](const Vector& theta) {
    const Vector m = samples.of_length(1.0), rate = samples.of_length(1.0), d = samples.of_length(1.0);
    const Matrix hessian = so3::xi_second_tangent(theta, m, rate);
    EXPECT_EQ(hessian, Matrix(hessian.transpose()));
    // The gradient of M . T^T theta' is Xi_dT(M)^T theta'.
    const ComplexMatrix xi = so3::xi_tangent(perturbed(theta, d), m.cast<Complex>());
    EXPECT_LT(distance(hessian * d, derivative(xi).transpose() * rate), 4 * roundoff);
  });
}

}  // namespace
}  // namespace flexarm::test
