#pragma once
/// Computes means of functions over an interval. The functions may have jumps and kinks.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace flexarm {
namespace mean_rule {

// Abscissae in the interval from -1 to 1: four (-1, -kNear, kNear, 1), or seven (-1, -kFar, -kNear, 0, kNear, kFar, 1).
// kFrom4, kFrom7: weights with which the interpolation polynomial through the values there gives the value at kTest.
// kTest is not in the middle, so that a staircase is not taken for a straight line.
constexpr double kTest = 0.2311, kNear = 0.44721359549995793, kFar = 0.81649658092772603;
constexpr std::array<double, 4> kFrom4 = {-0.070446997644374981, 0.28589746233639474, 0.89734352516360527,
                                          -0.112793989855625};
constexpr std::array<double, 7> kFrom7 = {-0.029952145923186596, 0.090511063311473822, -0.19414791061382486,
                                          0.63823603368299497,   0.60937011853700618,  -0.16197409337609273,
                                          0.04795693438162963};

}  // namespace mean_rule

/// Returns the mean of f over [begin, end], begin < end, to about 1e-13 of the largest absolute value of f there.
///
/// Uses Lobatto's rule with four points if the cubic through these predicts a fifth value. Else uses its extension to
/// seven points, which is exact to degree 9 (Gander and Gautschi, BIT 40, 2000), if their polynomial predicts that
/// value. Else bisects the interval, down to the resolution of double numbers. Values at the ends are limits from
/// inside, so a jump exactly at an end has no effect. The result is not finite if a value is not. Does not allocate,
/// and evaluates f about 4,000 times at most.
template <class Function>
double adaptive_mean(const Function& f, double begin, double end) {
  assert(begin < end);
  using namespace mean_rule;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon(), kTolerance = 2e-14;
  constexpr int kMostValues = 4000, kDepth = 64;
  const double width = end - begin;
  const double resolution = kEpsilon * std::max(std::abs(begin), std::abs(end));  // round-off of an abscissa
  const double inside = std::min(0.25 * width, std::max(std::ldexp(width, -44), 2 * resolution));
  struct Piece {
    double from, to, f_from, f_to;
  };
  std::array<Piece, kDepth> waiting;
  int pieces = 0, values = 2;
  waiting[pieces++] = {begin, end, f(begin + inside), f(end - inside)};
  double sum = 0, largest = 0;
  while (pieces > 0) {
    const Piece p = waiting[--pieces];
    const double middle = 0.5 * (p.from + p.to), half = 0.5 * (p.to - p.from), share = 2 * half / width;
    const double left = f(middle - kNear * half), right = f(middle + kNear * half), test = f(middle + kTest * half);
    values += 3;
    double mean = (p.f_from + p.f_to + 5 * (left + right)) / 12;
    double error =
        share * std::abs(kFrom4[0] * p.f_from + kFrom4[1] * left + kFrom4[2] * right + kFrom4[3] * p.f_to - test);
    const auto [low, high] = std::minmax({p.f_from, p.f_to, left, right, test});
    if (low == high) mean = low;  // without round-off
    largest = std::max({largest, std::abs(low), std::abs(high)});
    // Abscissae have round-off. So the values of a function that changes rapidly are uncertain, too.
    const double tolerance = kTolerance * largest + 4 * resolution / width * (high - low);
    // This condition is also false if a value is NaN, which ends the bisection.
    if (error > tolerance && half > 2 * resolution && values < kMostValues && pieces + 2 <= kDepth) {
      const double f_middle = f(middle), far_left = f(middle - kFar * half), far_right = f(middle + kFar * half);
      values += 3;
      mean = (77 * (p.f_from + p.f_to) + 432 * (far_left + far_right) + 625 * (left + right) + 672 * f_middle) / 2940;
      error = share * std::abs(kFrom7[0] * p.f_from + kFrom7[1] * far_left + kFrom7[2] * left + kFrom7[3] * f_middle +
                               kFrom7[4] * right + kFrom7[5] * far_right + kFrom7[6] * p.f_to - test);
      if (error > tolerance) {
        waiting[pieces++] = {p.from, middle, p.f_from, f_middle};
        waiting[pieces++] = {middle, p.to, f_middle, p.f_to};
        continue;
      }
    }
    sum += share * mean;
  }
  return sum;
}

/// The same for a function that is probably smooth: tries cheaper rules first. `is_smooth`: the function has no
/// branches, so that no pulse can hide between four values; then Simpson's rule is used if the parabola through its
/// three values predicts a fourth one to 3e-10 of the largest value. Else Lobatto's rule with four points is used if
/// the cubic predicts that value. For a sine wave, the error of Simpson's rule is then 1e-13 of its amplitude, that of
/// Lobatto's rule less. Evaluates f exactly at both ends, so that a function that caches its values can reuse them in
/// the next interval.
template <class Function>
double mean_of_what_may_be_smooth(const Function& f, double begin, double end, bool is_smooth) {
  assert(begin < end);
  using namespace mean_rule;
  constexpr double kForetold = 3e-10;
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const double first = f(begin), last = f(end), test = f(middle + kTest * half);
  const auto is_foretold = [&](double value, double largest) {
    return std::abs(value - test) <= kForetold * std::max({std::abs(first), std::abs(last), largest});
  };
  if (is_smooth) {
    const double between = f(middle), slope = 0.5 * (last - first), bend = 0.5 * (first + last) - between;
    if (is_foretold(between + kTest * (slope + kTest * bend), std::abs(between)))
      return first == last && first == between ? first : (first + 4 * between + last) / 6;
  }
  const double left = f(middle - kNear * half), right = f(middle + kNear * half);
  if (is_foretold(kFrom4[0] * first + kFrom4[1] * left + kFrom4[2] * right + kFrom4[3] * last,
                  std::max(std::abs(left), std::abs(right))))
    return first == last && first == left && first == right && first == test ? first
                                                                             : (first + last + 5 * (left + right)) / 12;
  return adaptive_mean(f, begin, end);
}

}  // namespace flexarm
