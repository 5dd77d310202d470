#pragma once
/// Cubic splines: smooth functions through points.

#include <vector>

namespace flexarm {

/// A function that is a cubic polynomial between points, with given rates at the points, and constant outside. Its rate
/// is continuous, except at an end where the given rate is not zero.
struct CubicSpline {
  std::vector<double> times, values, rates;  ///< at least two, times increasing

  double operator()(double t) const;
  double derivative(double t) const;  ///< at the ends: the limit from inside
};

/// Returns rates with which the spline through these points (at least two) is twice continuously differentiable, and
/// has zero rates at both ends.
std::vector<double> smoothest_rates(const std::vector<double>& times, const std::vector<double>& values);

}  // namespace flexarm
