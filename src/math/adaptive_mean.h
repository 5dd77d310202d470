#pragma once
/// Means of functions that may jump or have kinks anywhere.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace flexarm {
namespace mean_rule {

// Places in an interval from -1 to 1, and weights by which a polynomial through the values there gives the value at
// kTest: of 4 places -1, -kNear, kNear, 1, and of 7, -1, -kFar, -kNear, 0, kNear, kFar, 1. The test lies beside the
// middle, so that stairs are not taken for a slope.
constexpr double kTest = 0.2311, kNear = 0.44721359549995793, kFar = 0.81649658092772603;
constexpr std::array<double, 4> kFrom4 = {-0.070446997644374981, 0.28589746233639474, 0.89734352516360527,
                                          -0.112793989855625};
constexpr std::array<double, 7> kFrom7 = {-0.029952145923186596, 0.090511063311473822, -0.19414791061382486,
                                          0.63823603368299497,   0.60937011853700618,  -0.16197409337609273,
                                          0.04795693438162963};

}  // namespace mean_rule

/// Mean of f over [begin, end], begin < end, to about 1e-13 of its largest absolute value there: by Lobatto's rule of
/// four points where the cubic through these foretells a fifth value; else by its extension to seven points, exact to
/// degree 9 (Gander and Gautschi, BIT 40, 2000), where their polynomial does; else of both halves, until they are as
/// short as times can be told apart. Values at the ends are limits from inside: a jump at an end belongs to the
/// outside. Not finite where a value is not. No allocation; some 4,000 values at most.
template <class Function>
double adaptive_mean(const Function& f, double begin, double end) {
  assert(begin < end);
  using namespace mean_rule;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon(), kTolerance = 2e-14;
  constexpr int kMostValues = 4000, kDepth = 64;
  const double width = end - begin;
  const double resolution = kEpsilon * std::max(std::abs(begin), std::abs(end));  // of times
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
    // Times are rounded: where a function changes so much its values are not known any better.
    const double tolerance = kTolerance * largest + 4 * resolution / width * (high - low);
    // A value that is not a number ends this as well.
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

/// The same of a function that may have no corner at all, which is tried first: by Simpson's rule, where the parabola
/// through its three values foretells a fourth one to 3e-10 of the largest, else by Lobatto's rule, where the cubic
/// does. Of a wave that leaves Simpson's rule 1e-13 of it, and Lobatto's less. `is_smooth`: it has no branches, so that
/// no pulse can hide from four values. Values at the ends are those at the ends, so that who remembers them has them
/// for the next interval.
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
