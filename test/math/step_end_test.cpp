// Tests the times at which steps end.
#include "math/step_end.h"

#include <gtest/gtest.h>

#include "math/number_text.h"

namespace flexarm {
namespace {

/// The time after `count` steps.
double after(int count, double step, double begin = 0) {
  double time = begin;
  for (int n = 0; n < count; ++n) time = step_end(time, step);
  return time;
}

/// The number that is written as whole * 10^exponent.
double decimal(long whole, int exponent) {
  return parse_number(std::to_string(whole) + "e" + std::to_string(exponent)).value();
}

TEST(StepEnd, StepsOfDecimalLengthEndAtDecimalTimes) {
  struct Case {
    double step;
    long whole;
    int exponent;
  };
  for (const Case& c : {Case{0.001, 1, -3}, Case{0.0002, 2, -4}, Case{0.00125, 125, -5}, Case{1e-5, 1, -5},
                        Case{0.1, 1, -1}, Case{2, 2, 0}}) {
    double time = 0;
    for (long n = 1; n <= 12000; ++n) {
      time = step_end(time, c.step);
      ASSERT_EQ(time, decimal(n * c.whole, c.exponent)) << n << " steps of " << c.step;
    }
  }
}

TEST(StepEnd, OtherStepsEndAtMultiples) {
  for (const double step : {1.0 / 3, 1.0 / 60, 0.001 * std::sqrt(2.0)}) {
    double time = 0;
    for (int n = 1; n <= 12000; ++n) ASSERT_EQ(time = step_end(time, step), n * step);
  }
}

// A halved step, a step of another length in between, and a run that goes on do not disturb the sums.
TEST(StepEnd, LengthsMayChange) {
  EXPECT_EQ(after(1, 0.0005, after(1, 0.0005, 0.123)), 0.124);
  EXPECT_EQ(after(8, 0.001 / 8, 4.567), 4.568);
  EXPECT_EQ(after(700, 0.001, after(300, 0.0003, after(10, 0.001))), 0.8);
  EXPECT_EQ(after(2, 1.0 / 120, after(5, 1.0 / 60)), 6 * (1.0 / 60));
  EXPECT_EQ(after(4000, 0.001, 1000), 1004);
}

TEST(StepEnd, IsTheSumUpToRoundOff) {
  for (const double time : {0.0, 0.1 + 0.2, 1.0 / 7, 123.456, 1e9 / 3, 1e15})
    for (const double step : {0.0, 1e-3, -1e-3, 1.0 / 3, 1e-17, 1e-300})
      EXPECT_NEAR(step_end(time, step), time + step, 6e-16 * (time + std::abs(step))) << time << " " << step;
}

}  // namespace
}  // namespace flexarm
