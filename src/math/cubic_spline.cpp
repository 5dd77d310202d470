#include "math/cubic_spline.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace flexarm {
namespace {

/// The piece of a spline that contains a time, with the local coordinate s from 0 to 1.
struct Piece {
  Piece(const CubicSpline& spline, double t) {
    const auto inner_end = spline.times.end() - 1;
    const std::size_t i = std::upper_bound(spline.times.begin() + 1, inner_end, t) - spline.times.begin();
    length = spline.times[i] - spline.times[i - 1];
    s = (t - spline.times[i - 1]) / length;
    begin = spline.values[i - 1];
    end = spline.values[i];
    begin_slope = length * spline.rates[i - 1];
    end_slope = length * spline.rates[i];
  }
  double length, s, begin, end, begin_slope, end_slope;
};

}  // namespace

double CubicSpline::operator()(double t) const {
  assert(times.size() >= 2 && values.size() == times.size() && rates.size() == times.size());
  if (t <= times.front()) return values.front();
  if (t >= times.back()) return values.back();
  const Piece p(*this, t);
  const double r = 1 - p.s;
  return r * r * ((1 + 2 * p.s) * p.begin + p.s * p.begin_slope) + p.s * p.s * ((1 + 2 * r) * p.end - r * p.end_slope);
}

double CubicSpline::derivative(double t) const {
  assert(times.size() >= 2 && values.size() == times.size() && rates.size() == times.size());
  if (t < times.front() || t > times.back()) return 0;
  const Piece p(*this, t);
  const double r = 1 - p.s;
  return (6 * r * p.s * (p.end - p.begin) + r * (1 - 3 * p.s) * p.begin_slope + p.s * (1 - 3 * r) * p.end_slope) /
         p.length;
}

std::vector<double> smoothest_rates(const std::vector<double>& times, const std::vector<double>& values) {
  assert(times.size() >= 2 && values.size() == times.size());
  const std::size_t last = times.size() - 1;
  std::vector<double> rates(times.size(), 0.0), above(times.size(), 0.0);
  // The equations are h_1 r_(i-1) + 2 (h_0 + h_1) r_i + h_0 r_(i+1) = 3 (h_1 d_0 + h_0 d_1), with the slopes d of the
  // chords on both sides. The matrix is diagonally dominant, so elimination needs no pivoting.
  for (std::size_t i = 1; i < last; ++i) {
    const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
    const double slope_before = (values[i] - values[i - 1]) / before, slope_after = (values[i + 1] - values[i]) / after;
    const double pivot = 2 * (before + after) - after * above[i - 1];
    above[i] = before / pivot;
    rates[i] = (3 * (after * slope_before + before * slope_after) - after * rates[i - 1]) / pivot;
  }
  for (std::size_t i = last; i-- > 1;) rates[i] -= above[i] * rates[i + 1];
  return rates;
}

}  // namespace flexarm
