/// Tests the search for the root of an increasing function: smooth, kinked or with a jump. The last evaluation is at
/// the root.
#include "math/increasing_root.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

using namespace flexarm;

namespace {

TEST(IncreasingRoot, IsWhereItWasEvaluatedLast) {
  constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
  double evaluated = 0;
  const auto root = [&](const auto& function, double guess) {
    const auto evaluate = [&](double x) -> ValueAndSlope {
      evaluated = x;
      return function(x);
    };
    return increasing_root(evaluate, guess, 1);
  };
  const auto cubic = [](double x) -> ValueAndSlope { return {x * x * x - 2, 3 * x * x}; };
  const auto kinked = [](double x) -> ValueAndSlope { return {x < 1 ? x - 1.5 : 8 * (x - 1) - 0.5, x < 1 ? 1.0 : 8}; };
  const auto jump = [](double x) -> ValueAndSlope { return {x < M_PI ? -1.0 : 1.0, 0}; };
  for (const double guess : {-30.0, -1.0, 0.3, 1.2, 40.0}) {
    EXPECT_NEAR(root(cubic, guess), std::cbrt(2), 2 * kRoundOff);
    EXPECT_NEAR(evaluated, std::cbrt(2), 4 * kRoundOff);
    EXPECT_NEAR(root(kinked, guess), 1.0625, 2 * kRoundOff);
    EXPECT_NEAR(evaluated, 1.0625, 4 * kRoundOff);
    EXPECT_NEAR(root(jump, guess), M_PI, 4 * kRoundOff);
    EXPECT_NEAR(evaluated, M_PI, 8 * kRoundOff);
  }
}

}  // namespace
