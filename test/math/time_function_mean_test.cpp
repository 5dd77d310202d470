/// Tests means of functions of time over intervals, and the corners of these functions, against closed forms.
#include "flexarm/math/time_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "math/adaptive_mean.h"

namespace flexarm {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A function and its integral from 0 to t.
struct Case {
  std::string text;
  std::function<double(double)> integral;
  double largest;  // largest absolute value
};

std::vector<Case> cases() {
  const auto ramp = [](double t) { return std::pow(std::max(t, 0.0), 2) / 2; };
  const auto wave = [](double t) {  // integral of |sin| from 0
    const double whole = std::floor(t / M_PI);
    return 2 * whole + 1 - std::cos(t - M_PI * whole);
  };
  return {
      {"7", [](double t) { return 7 * t; }, 7},
      {"3*t^2", [](double t) { return t * t * t; }, 12},
      {"sin(20*t)", [](double t) { return (1 - std::cos(20 * t)) / 20; }, 1},
      {"t < 0.3125 ? 3 : -3", [](double t) { return 3 * (std::min(t, 0.3125) - std::max(t - 0.3125, 0.0)); }, 3},
      {"t > sqrt(0.2) && t < sqrt(0.7) ? 5 : 0",
       [](double t) { return 5 * (std::clamp(t, std::sqrt(0.2), std::sqrt(0.7)) - std::sqrt(0.2)); }, 5},
      {"abs(sin(3*t))", [wave](double t) { return wave(3 * t) / 3; }, 1},
      {"sign(sin(7*t))", [](double t) { return std::abs(std::remainder(7 * t, 2 * M_PI)) / 7; }, 1},
      {"min(1, 2*t)", [ramp](double t) { return 2 * ramp(t) - 2 * ramp(t - 0.5); }, 1},
      {"rint(4*t)",  // steps of 1 at 1/8 + k/4
       [](double t) {
         double sum = 0;
         for (double at = 0.125; at < t; at += 0.25) sum += t - at;
         return sum;
       },
       8},
      {"0:1 0.5:3 0.75:-1 1.5:0",
       [ramp](double t) {
         return t + 4 * ramp(t) - 20 * ramp(t - 0.5) + (16 + 4.0 / 3) * ramp(t - 0.75) - 4.0 / 3 * ramp(t - 1.5);
       },
       3},
      {"0:0:0 1:1:3 2:8:12", [](double t) { return std::pow(t, 4) / 4; }, 8},
  };
}

TEST(TimeFunctionMean, IsThatOfClosedForms) {
  for (const Case& example : cases()) {
    const TimeFunction function = TimeFunction::parse(example.text);
    for (const double begin : {0.0, 0.04, 0.3124, 0.3125, 0.4471, 0.83, 1.0466})
      for (const double width : {1e-4, 1e-3, 1.7e-3, 0.05, 0.9}) {
        const double end = begin + width;
        const double mean = (example.integral(end) - example.integral(begin)) / width;
        // The closed forms subtract numbers as large as the largest integral, and times are rounded.
        const double tolerance = example.largest * (2e-13 + 32 * kEpsilon / width);
        EXPECT_NEAR(function.mean(begin, end), mean, tolerance) << example.text << " from " << begin << " to " << end;
        EXPECT_EQ(function.mean(end, begin), function.mean(begin, end)) << example.text;
      }
    EXPECT_EQ(function.mean(0.7, 0.7), function(0.7)) << example.text;
  }
}

TEST(TimeFunctionMean, OfTheOutsideIsTheEnd) {
  EXPECT_NEAR(TimeFunction::parse("1:7").mean(-3, 2), 7, 8 * kEpsilon);
  EXPECT_EQ(TimeFunction::parse("1:7 2:9").mean(3, 5), 9);
  EXPECT_EQ(TimeFunction::parse("1:7:3 2:9:3").mean(-1, 1), 7);
  EXPECT_NEAR(TimeFunction::parse("0:0 1:1").mean(-1, 3), 2.5 / 4, 4 * kEpsilon);
}

/// A function that is cut at -limit and limit: `integral` is its mean from `begin` to `end` times (end - begin).
struct CutCase {
  std::string text;
  double limit, begin, end, integral;
};

TEST(TimeFunctionMean, WithinALimitIsThatOfWhatIsCutAtEachInstant) {
  const double jump = std::sqrt(0.1), third = 1.0 / 3;
  for (const CutCase& c :
       {CutCase{"7", 3, 0, 2, 6}, CutCase{"-7", 3, 0, 2, -6}, CutCase{"7", 8, 0, 2, 14},
        CutCase{"0:0 1:4", 2, 0, 1, 1.5}, CutCase{"0:0 1:4", 5, 0, 1, 2},
        // The second of these functions, from -1.5 on: -1 up to 1/3, through 0 up to 2/3, then 1.
        CutCase{"0:-3 1:3", 1, 0.25, 1, -(third - 0.25) + third}, CutCase{"0:-3 1:3", 1, 0, 1, 0},
        // A triangle to 4 and back, then -5: its top is cut from 1/2 to 3/2.
        CutCase{"0:0 1:4 2:0 3:-5", 2, 0, 2, 0.5 + 2 + 0.5}, CutCase{"0:0 1:4 2:0 3:-5", 2, 2, 4, -0.4 - 0.6 * 2 - 2},
        CutCase{"t < sqrt(0.1) ? 30 : -3", 3, 0, 1, 3 * jump - 3 * (1 - jump)},
        // 5 sin t is above 2.5 from pi/6 to 5 pi/6.
        CutCase{"5*sin(t)", 2.5, 0, M_PI, 10 * (1 - std::cos(M_PI / 6)) + 2.5 * 2 * M_PI / 3},
        CutCase{"5*sin(t)", 2.5, 0, 2 * M_PI, 0},
        // t^3
        CutCase{"0:0:0 1:1:3 2:8:12", 1, 0, 2, 0.25 + 1}}) {
    const TimeFunction function = TimeFunction::parse(c.text);
    const double mean = c.integral / (c.end - c.begin), tolerance = c.limit * (2e-13 + 32 * kEpsilon);
    EXPECT_NEAR(function.mean_within(c.limit, c.begin, c.end), mean, tolerance) << c.text << " within " << c.limit;
    EXPECT_EQ(function.mean_within(c.limit, c.end, c.begin), function.mean_within(c.limit, c.begin, c.end)) << c.text;
    EXPECT_EQ(function.mean_within(c.limit, 0.7, 0.7), std::clamp(function(0.7), -c.limit, c.limit)) << c.text;
  }
}

TEST(TimeFunctionMean, WithinALimitThatIsNotMetIsTheMean) {
  for (const Case& example : cases()) {
    const TimeFunction function = TimeFunction::parse(example.text);
    const double limit = 1.01 * example.largest, tolerance = example.largest * 4e-13;
    for (const double begin : {0.0, 0.3124, 0.83})
      EXPECT_NEAR(function.mean_within(limit, begin, begin + 0.05), function.mean(begin, begin + 0.05), tolerance)
          << example.text << " from " << begin;
  }
}

TEST(TimeFunctionMean, LeavesJumpsAtItsEndsOutside) {
  const TimeFunction step = TimeFunction::parse("t < 0.3 ? 3 : -3");
  EXPECT_EQ(step.mean(0.299, 0.3), 3);
  EXPECT_EQ(step.mean(0.3, 0.301), -3);
  EXPECT_NEAR(TimeFunction::parse("sin(t)/t").mean(0, 1e-3), 1, 1e-6 / 18 * 1.01);
}

TEST(TimeFunctionMean, IsNotFiniteWhereValuesAreNot) {
  EXPECT_FALSE(std::isfinite(TimeFunction::parse("sqrt(t-1)").mean(0.2, 0.3)));
  EXPECT_FALSE(std::isfinite(TimeFunction::parse("t > 0.25 ? 1/0 : 1").mean(0.2, 0.3)));
}

/// Returns the number of values that a mean evaluates.
int values_of(const std::function<double(double)>& function, double begin, double end) {
  int count = 0;
  adaptive_mean([&](double t) { return ++count, function(t); }, begin, end);
  return count;
}

TEST(TimeFunctionMean, IsCheapWhereTheFunctionIsSmooth) {
  for (const double t : {0.0, 0.3, 10.0, 1000.0}) {
    EXPECT_LE(values_of([](double time) { return std::sin(time); }, t, t + 1e-3), 5) << t;
    EXPECT_LE(values_of([](double time) { return 50 * std::sin(6.3 * time) + time; }, t, t + 1e-3), 8) << t;
  }
}

TEST(TimeFunctionMean, IsCheaperWhereItMayBeSmooth) {
  const auto values = [](const std::function<double(double)>& function, double begin, bool is_smooth) {
    int count = 0;
    mean_of_what_may_be_smooth([&](double t) { return ++count, function(t); }, begin, begin + 1e-3, is_smooth);
    return count;
  };
  for (const double t : {0.0, 0.3, 10.0, 1000.0}) {
    EXPECT_EQ(values([](double time) { return std::cos(2 * time); }, t, true), 4) << t;
    EXPECT_LE(values([](double time) { return std::sin(20 * time); }, t, true), 6) << t;
    EXPECT_EQ(values([](double time) { return 50 * std::sin(6.3 * time) + time; }, t, false), 5) << t;
    EXPECT_EQ(values([](double) { return 7.0; }, t, false), 5) << t;
  }
}

// A pulse wider than a third of the interval is found wherever it is.
TEST(TimeFunctionMean, MissesNoPulseBetweenItsValues) {
  for (double begin = 0; begin < 0.63; begin += 0.01) {
    const double end = begin + 0.36;
    const TimeFunction pulse =
        TimeFunction::parse("t > " + std::to_string(begin) + " && t < " + std::to_string(end) + " ? 2 : 0");
    EXPECT_NEAR(pulse.mean(0, 1), 2 * 0.36, 1e-12) << begin;
  }
}

TEST(TimeFunctionMean, IsBoundedInWork) {
  EXPECT_LT(values_of([](double t) { return t < 0.12345 ? 0.0 : 1.0; }, 0, 1), 500);
  EXPECT_LT(values_of([](double t) { return std::sin(1e9 * t * t) > 0 ? 1.0 : 0.0; }, 0, 1), 4200);
  EXPECT_LT(values_of([](double t) { return 1 / t; }, 0, 1), 4200);
}

// ---------------------------------------------------------------- corners

void expect_corners(const std::string& text, const std::vector<double>& expected, double begin = 0, double end = 2,
                    double tolerance = 1e-15) {
  const std::vector<double> corners = TimeFunction::parse(text).corners(begin, end);
  ASSERT_EQ(corners.size(), expected.size()) << text << ": " << ::testing::PrintToString(corners);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(corners[i], expected[i], tolerance * std::max(1.0, std::abs(expected[i]))) << text;
}

TEST(TimeFunctionCorners, OfTablesAreWhereTheirSlopeChanges) {
  expect_corners("0:1 0.5:3 0.75:-1 1.5:0", {0.5, 0.75, 1.5});
  expect_corners("0.1:1 0.2:2 0.3:3 0.7:7 0.8:7 1:7 1.5:8", {0.1, 0.7, 1, 1.5});
  expect_corners("0.5:2 1:2", {});
  expect_corners("1:7", {});
}

TEST(TimeFunctionCorners, OfSplinesAreEndsWithARate) {
  expect_corners("0.5:0:1 1:2:0 1.5:3:-1", {0.5, 1.5});
  expect_corners("0.5:0:0 1:2:1 1.5:3:0", {});
}

TEST(TimeFunctionCorners, OfSmoothExpressionsAreNone) {
  for (const char* text : {"7", "sin(40*t)", "3*t^2-1", "exp(-t)*cos(100*t)", "sin(t) > 2 ? 1 : t", "sqrt(t)", "t^0.3",
                           "1/(0.1+t^2)", "1000+sin(t)*1e-3", "-t^2", "2^-t", "atan2(t,1)"})
    expect_corners(text, {});
}

TEST(TimeFunctionCorners, AreFoundByBranches) {
  expect_corners("t<0.3125 ? 3 : -3", {0.3125});
  expect_corners("t<=0.3125 ? 3 : -3", {0.3125});
  expect_corners("t > 0.5001 && t < 0.50011", {0.5001, 0.50011});
  expect_corners("t > 0.50001 ? (t > 0.50002 ? 3 : 2) : 1", {0.50001, 0.50002});
  expect_corners("t > sqrt(2) || t < 0.1", {0.1, std::sqrt(2.0)});
  expect_corners("abs(sin(3*t))", {M_PI / 3});
  expect_corners("sign(sin(3*t))", {M_PI / 3});
  expect_corners("min(1,2*t)", {0.5});
  expect_corners("max(1-t,2*t,1.5)", {0.75});
  expect_corners("rint(2*t)", {0.25, 0.75, 1.25, 1.75});
  expect_corners("rint(2*t)", {-1.25, -0.75, -0.25}, -1.5, 0);
  // Nearly touching: pairs that are closer to each other than the times at which the search evaluates.
  const double apart = std::acos(0.999999999) / 10;
  expect_corners("sin(10*t) > 0.999999999", {M_PI / 20 - apart, M_PI / 20 + apart}, 0, 0.5, 1e-7);
  expect_corners("sin(10*t) > 0.999999999", {M_PI / 20 - apart, M_PI / 20 + apart}, 0, 0.5, 1e-7);
}

TEST(TimeFunctionCorners, AreFoundWithoutBranches) {
  expect_corners("acos(cos(3*t))", {M_PI / 3}, 0, 2, std::sqrt(8 * kEpsilon) / 3);  // a cosine near -1 is rounded
  expect_corners("sqrt((t-0.7123)^2)", {0.7123}, 0, 2, 1e-9);
  expect_corners("atan2(sin(3*t),cos(3*t))", {M_PI / 3}, 0, 2, 1e-12);
}

TEST(TimeFunctionCorners, AreThoseOfAnEntireWave) {
  std::vector<double> expected;
  for (int i = 1; i < 2000; ++i) expected.push_back(i * 0.005);
  expect_corners("sin(628.31853071795865*t) > 0 ? 1 : -1", expected, 0, 10, 1e-14);
  EXPECT_LE(TimeFunction::parse("sign(sin(1e7*t))").corners(0, 10).size(), 10000u);
}

TEST(TimeFunctionMean, RefusesWhatIsNoTimeOrLimit) {
  for (const char* text : {"sin(t)", "0:0 1:1", "0:0:0 1:1:0"}) {
    const TimeFunction function = TimeFunction::parse(text);
    for (const double bad : {double(NAN), double(INFINITY)}) {
      EXPECT_THROW(function.mean(0, bad), std::invalid_argument) << text;
      EXPECT_THROW(function.mean(-bad, 0), std::invalid_argument) << text;
      EXPECT_THROW(function.mean_within(1, 0, bad), std::invalid_argument) << text;
      EXPECT_THROW(function.corners(0, bad), std::invalid_argument) << text;
    }
    for (const double limit : {0.0, -1.0, double(NAN)})
      EXPECT_THROW(function.mean_within(limit, 0, 1), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace flexarm
