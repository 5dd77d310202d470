/// Tests the degree of exactness of Gauss-Legendre rules, for every number of points.

#include "math/quadrature.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

// The weights add up to 2. Each term has a few roundings: the rounding of the abscissa counts as many times as the
// degree (9 at most).
constexpr double quadrature_roundoff = 16 * std::numeric_limits<double>::epsilon();

template <int Points>
double integral_of_power(int degree) {
  double sum = 0;
  for (int i = 0; i < Points; ++i) {
    sum += GaussLegendre<Points>::weights[i] * std::pow(GaussLegendre<Points>::points[i], degree);
  }
  return sum;
}

double exact_integral_of_power(int degree) {
  return degree % 2 == 1 ? 0.0 : 2.0 / (degree + 1);
}

template <typename Count>
class GaussLegendreTest : public ::testing::Test {};

using PointCounts =
    ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                     std::integral_constant<int, 4>, std::integral_constant<int, 5>>;
TYPED_TEST_SUITE(GaussLegendreTest, PointCounts);

TYPED_TEST(GaussLegendreTest, IsExactToDegreeTwiceThePointsMinusOne) {
  constexpr int points = TypeParam::value;
  for (int degree = 0; degree < 2 * points; ++degree) {
    EXPECT_NEAR(integral_of_power<points>(degree), exact_integral_of_power(degree), quadrature_roundoff)
        << "degree " << degree;
  }
}

TYPED_TEST(GaussLegendreTest, MissesTheNextDegreeByTheKnownRemainder) {
  constexpr int n = TypeParam::value;
  // The square of the monic Legendre polynomial has the integral 2^(2n+1) n!^4 / ((2n+1) (2n)!^2), for which the rule
  // gives zero.
  const double factorial = std::tgamma(n + 1.0), factorial2 = std::tgamma(2 * n + 1.0);
  const double remainder = std::pow(2.0, 2 * n + 1) * std::pow(factorial, 4) / ((2 * n + 1) * factorial2 * factorial2);
  EXPECT_NEAR(exact_integral_of_power(2 * n) - integral_of_power<n>(2 * n), remainder, quadrature_roundoff);
}

TYPED_TEST(GaussLegendreTest, PointsIncreaseAndAreSymmetric) {
  constexpr int points = TypeParam::value;
  using Rule = GaussLegendre<points>;
  for (int i = 0; i < points; ++i) {
    EXPECT_EQ(Rule::points[i], -Rule::points[points - 1 - i]);
    EXPECT_EQ(Rule::weights[i], Rule::weights[points - 1 - i]);
    if (i > 0) {
      EXPECT_LT(Rule::points[i - 1], Rule::points[i]);
    }
  }
}

}  // namespace
}  // namespace flexarm
