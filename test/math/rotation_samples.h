#pragma once
/// Random samples, reference solutions and error measures for the tests of rotations.

#include <complex>
#include <limits>
#include <random>
#include <vector>

#include "math/so3.h"

namespace flexarm::test {

using Complex = std::complex<double>;
using Vector = Vector3T<double>;
using Matrix = Matrix3T<double>;
using LongVector = Vector3T<long double>;
using LongMatrix = Matrix3T<long double>;
using ComplexVector = Vector3T<Complex>;
using ComplexMatrix = Matrix3T<Complex>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Entries of the operators are sums of a handful of products. 16 roundings, relative to the largest entry, bound their
/// error.
constexpr double roundoff = 16 * epsilon;
constexpr double pi = 3.14159265358979323846;
constexpr long double long_pi = 3.141592653589793238462643383279502884L;

/// Complex step: so small that its square vanishes compared with any number.
constexpr double complex_step = 1e-40;

/// Angles from zero to pi, dense near the switches of method (0.49, 1, 2, 2 pi / 3).
inline std::vector<double> angles_to_pi() {
  return {0.0,   1e-12, 1e-9, 1e-6,   1e-4,   1e-3, 0.01, 0.1, 0.3, 0.48, 0.489,     0.49,      0.5,      0.7,
          0.999, 1.001, 1.5,  1.9999, 2.0001, 2.09, 2.1,  2.5, 3.0, 3.1,  pi - 1e-3, pi - 1e-7, pi - 1e-9};
}

inline std::vector<double> angles_to_two_pi() {
  std::vector<double> angles = angles_to_pi();
  for (const double angle : {pi, pi + 1e-9, 3.2, 4.0, 4.5, 5.0, 5.5, 6.0, 6.2, 2 * pi - 1e-2, 2 * pi - 1e-3})
    angles.push_back(angle);
  return angles;
}

/// Makes reproducible random vectors.
class Samples {
 public:
  Vector vector() { return {normal_(engine_), normal_(engine_), normal_(engine_)}; }
  Vector of_length(double length) { return length * vector().normalized(); }
  template <int Components>
  Eigen::Matrix<double, Components, 1> direction() {
    return Eigen::Matrix<double, Components, 1>::NullaryExpr([this] { return normal_(engine_); }).normalized();
  }
  /// Returns directions for which different pivots are chosen: axes, a coordinate plane, general ones.
  std::vector<Vector> directions() {
    return {Vector::UnitX(), -Vector::UnitY(), Vector::UnitZ(), Vector(1, -1, 0).normalized(),
            of_length(1.0),  of_length(1.0),   of_length(1.0)};
  }

 private:
  std::mt19937 engine_{20040601};
  std::normal_distribution<double> normal_;
};

/// Returns sum_n hat(theta)^n / (n + shift)! in long double: exp for shift 0, T for shift 1. Uses no coefficient of
/// so3.h.
template <typename V>
LongMatrix power_series(const Eigen::MatrixBase<V>& theta, int shift) {
  const LongMatrix skew = so3::hat(theta.template cast<long double>());
  LongMatrix term = LongMatrix::Identity(), sum = term;
  for (int n = 1; n < 70; ++n) {
    term = LongMatrix(term * skew) / static_cast<long double>(n + shift);
    sum += term;
  }
  return sum;
}

template <int Components>
Eigen::Matrix<Complex, Components, 1> perturbed(const Eigen::Matrix<double, Components, 1>& x,
                                                const Eigen::Matrix<double, Components, 1>& direction) {
  return x.template cast<Complex>() + Complex(0, complex_step) * direction.template cast<Complex>();
}

/// Returns a rotation matrix perturbed by a spatial spin.
inline ComplexMatrix spun(const Matrix& rotation, const Vector& spin) {
  return rotation.cast<Complex>() + Complex(0, complex_step) * Matrix(so3::hat(spin) * rotation).cast<Complex>();
}

/// Returns the derivative, which is stored in the imaginary part.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> derivative(const Eigen::Matrix<Complex, Rows, Columns>& value) {
  return value.imag() / complex_step;
}

/// Returns the largest absolute difference of two matrices of any real scalars.
template <typename A, typename B>
double distance(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return static_cast<double>((a.template cast<long double>() - b.template cast<long double>()).cwiseAbs().maxCoeff());
}

template <typename A>
double size(const Eigen::MatrixBase<A>& a) {
  return static_cast<double>(a.cwiseAbs().maxCoeff());
}

}  // namespace flexarm::test
