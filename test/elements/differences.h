#pragma once
/// Derivatives by finite differences, for tests of tangents.

#include <cmath>

#include <Eigen/Core>

namespace flexarm::test {

/// Step of the differences, for functions that vary over lengths and angles of order one.
constexpr double difference_step = 0.01;
/// Error of difference() for these functions, relative to the largest value or derivative. Truncation: h^6 / 64 = 2e-14
/// times seventh derivatives over 7!. Round-off: epsilon / (h / 4) = 1e-13 times the largest value. The margin covers
/// the constants of both.
constexpr double difference_tolerance = 1e-10;

/// df/dh at h = 0 of a vector- or matrix-valued function f, by central differences with three steps, extrapolated
/// twice.
template <class Function>
auto difference(const Function& f, double step = difference_step) {
  using Value = std::decay_t<decltype(f(0.0))>;
  const auto central = [&](double h) { return Value((f(h) - f(-h)) / (2 * h)); };
  const Value coarse = central(step), middle = central(step / 2), fine = central(step / 4);
  const Value first = (4 * middle - coarse) / 3, second = (4 * fine - middle) / 3;
  return Value((16 * second - first) / 15);
}

/// The same for a scalar function.
template <class Function>
double scalar_difference(const Function& f, double step = difference_step) {
  using One = Eigen::Matrix<double, 1, 1>;
  return difference([&](double h) { return One(One::Constant(f(h))); }, step)[0];
}

/// Largest absolute entry.
template <class Matrix>
double largest(const Eigen::MatrixBase<Matrix>& matrix) {
  return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.0;
}

}  // namespace flexarm::test
