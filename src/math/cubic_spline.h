#pragma once
/// A smooth function through points.

#include <vector>

namespace flexarm {

/// Cubic between points at which it has given rates, and constant outside. Its rate is continuous, but at an end where
/// the given one is not zero.
struct CubicSpline {
  std::vector<double> times, values, rates;  ///< at least two, times increasing

  double operator()(double t) const;
  double derivative(double t) const;  ///< at an end that of the inside
};

/// Rates with which the spline through these points, of which there are at least two, is twice continuously
/// differentiable and starts and ends at rest.
std::vector<double> smoothest_rates(const std::vector<double>& times, const std::vector<double>& values);

}  // namespace flexarm
