/// Tests functions of time: constants, expressions, tables and splines that are read from text, their derivatives, and
/// the errors of bad texts.
#include "flexarm/math/time_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>
#include <optional>
#include <stdexcept>
#include <vector>

using flexarm::TimeFunction;

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Returns the message of the error that parsing `text` throws, or an empty text if it throws none.
std::string parse_error(const std::string& text) {
  try {
    TimeFunction::parse(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_error(const std::string& text, const std::string& fragment) {
  const std::string message = parse_error(text);
  EXPECT_NE(message.find(fragment), std::string::npos) << "'" << text << "' gave: " << message;
}

/// A locale with a decimal comma, as many European locales have it.
struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

}  // namespace

TEST(TimeFunction, IsOneByDefaultAndTheGivenConstant) {
  EXPECT_EQ(TimeFunction()(17), 1);
  EXPECT_EQ(TimeFunction(-2.5)(0.1), -2.5);
  EXPECT_EQ(TimeFunction(-2.5).text(), "-2.5");
  EXPECT_EQ(TimeFunction(-2.5).derivative(3), 0);
}

TEST(TimeFunction, ReadsConstants) {
  EXPECT_EQ(TimeFunction::parse("50")(3), 50);
  EXPECT_EQ(TimeFunction::parse("  +1e-3 ")(3), 1e-3);
  EXPECT_EQ(TimeFunction::parse("0.1")(0), 0.1);
}

TEST(TimeFunction, ReadsExpressions) {
  EXPECT_EQ(TimeFunction::parse("t < 1 ? t : 0")(0.25), 0.25);
  EXPECT_EQ(TimeFunction::parse("t < 1 ? t : 0")(1.5), 0);
  EXPECT_NEAR(TimeFunction::parse("sin(2*_pi*t)")(0.25), 1, 4 * kEpsilon);
  EXPECT_EQ(TimeFunction::parse("t >= 1 && t <= 2")(1.5), 1);
  EXPECT_EQ(TimeFunction::parse("3*t^2").text(), "3*t^2");
}

TEST(TimeFunction, ReadsTables) {
  const TimeFunction table = TimeFunction::parse("0:0 1:50\n 2:-2e1");
  EXPECT_EQ(table(-1), 0);
  EXPECT_EQ(table(0.5), 25);
  EXPECT_EQ(table(1), 50);
  EXPECT_EQ(table(1.5), 15);
  EXPECT_EQ(table(9), -20);
  EXPECT_EQ(TimeFunction::parse("1:7")(-3), 7);
}

TEST(TimeFunction, ReadsTablesWithRates) {
  // The function is cubic between its points, so it reproduces t^3.
  const TimeFunction cube = TimeFunction::parse("-1:-1:3 0:0:0\n 2:8:12");
  for (const double t : {-1.0, -0.7, 0.0, 0.3, 1.9, 2.0}) {
    EXPECT_NEAR(cube(t), t * t * t, 8 * kEpsilon * 8) << t;
    EXPECT_NEAR(cube.derivative(t), 3 * t * t, 8 * kEpsilon * 12) << t;
  }
  EXPECT_EQ(cube(-5), -1);
  EXPECT_EQ(cube(2.1), 8);
  EXPECT_EQ(cube.derivative(-5), 0);
  EXPECT_EQ(cube.derivative(2.1), 0);
}

namespace {

/// Returns the spline through points of sin^2, which rests at 0 and pi, with or without given rates.
TimeFunction spline_of_squared_sine(int pieces, bool with_rates) {
  std::vector<double> times, values, rates;
  for (int i = 0; i <= pieces; ++i) {
    times.push_back(M_PI * i / pieces);
    values.push_back(std::pow(std::sin(times.back()), 2));
    if (with_rates) rates.push_back(std::sin(2 * times.back()));
  }
  return TimeFunction::spline(times, values, rates);
}

}  // namespace

TEST(TimeFunction, SplinesAreOfFourthOrderAndTheirRatesOfThird) {
  for (const bool with_rates : {false, true}) {
    double value_error[2] = {}, rate_error[2] = {};
    for (const int k : {0, 1}) {
      const TimeFunction spline = spline_of_squared_sine(20 << k, with_rates);
      for (double t = 0.005; t < M_PI; t += 0.01) {
        value_error[k] = std::max(value_error[k], std::abs(spline(t) - std::pow(std::sin(t), 2)));
        rate_error[k] = std::max(rate_error[k], std::abs(spline.derivative(t) - std::sin(2 * t)));
      }
    }
    EXPECT_NEAR(std::log2(value_error[0] / value_error[1]), 4, 0.3) << with_rates;
    EXPECT_NEAR(std::log2(rate_error[0] / rate_error[1]), 3, 0.3) << with_rates;
  }
}

TEST(TimeFunction, SplinesWithoutRatesAreSmoothAndRestAtTheirEnds) {
  const std::vector<double> times = {0.5, 0.6, 1.5, 1.8, 4};
  const TimeFunction spline = TimeFunction::spline(times, {1, 3, -2, 0, 5});
  EXPECT_EQ(spline.derivative(0.5), 0);
  EXPECT_EQ(spline.derivative(4), 0);
  const double h = 1e-3;  // the rate is quadratic in a piece, for which these differences of second order are exact
  for (const double t : {0.6, 1.5, 1.8}) {
    const auto rate = [&](int i) { return spline.derivative(t + i * h); };
    const double before = (3 * rate(0) - 4 * rate(-1) + rate(-2)) / (2 * h);
    const double after = (-3 * rate(0) + 4 * rate(1) - rate(2)) / (2 * h);
    EXPECT_NEAR(before, after, 100 * kEpsilon * 40 / h) << t;  // rates are at most 40
  }
}

TEST(TimeFunction, SplinesAreWhatTheirTextSays) {
  const TimeFunction spline = TimeFunction::spline({0, 0.1, 1e-3 + 0.3}, {1 / 3.0, -2e-7, 5});
  const TimeFunction again = TimeFunction::parse(spline.text());
  EXPECT_EQ(again.text(), spline.text());
  for (double t = -0.1; t < 0.4; t += 0.01) EXPECT_EQ(again(t), spline(t));
}

TEST(TimeFunction, RefusesWhatIsNoSpline) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TimeFunction::spline({0}, {1}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, 1}, {1}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, 1}, {1, 2}, {0}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, 0}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, nan}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, 1}, {nan, 2}), std::invalid_argument);
  EXPECT_THROW(TimeFunction::spline({0, 1, 2}, {-1e308, 1e308, 0}), std::invalid_argument) << "rates overflow";
  expect_error("0:1:2", "a single point");
  expect_error("0:1:2 1:2", "'1:2'");
  expect_error("0:1 1:2:3", "'1:2:3'");
  expect_error("0:1:2:3", "'0:1:2:3'");
  expect_error("0:1:x 1:2:3", "'0:1:x'");
}

TEST(TimeFunction, CopiesAreIndependent) {
  for (const std::string text : {"t*t", "0:0 1:1 2:4 3:9", "0:0:0 2:4:4 3:9:6", "9"}) {
    std::optional<TimeFunction> original = TimeFunction::parse(text);
    const TimeFunction copy = *original, copy_of_copy = copy;
    TimeFunction assigned(5);
    assigned = copy;
    EXPECT_EQ((*original)(2), text == "9" ? 9 : 4);
    original.reset();
    for (const TimeFunction& other : {copy, copy_of_copy, assigned}) {
      EXPECT_EQ(other(3), 9) << text;
      EXPECT_EQ(other.text(), text);
    }
    const TimeFunction moved = std::move(assigned);
    EXPECT_EQ(moved(3), 9) << text;
  }
}

TEST(TimeFunction, DerivativeIsAccurateToItsOrder) {
  // Truncation h^2/6 |f'''| plus round-off eps/h, with h = cbrt(eps): both are of order eps^(2/3).
  const double tolerance = 4 * std::pow(kEpsilon, 2.0 / 3.0);
  const TimeFunction sine = TimeFunction::parse("sin(t)");
  for (const double t : {-2.0, -0.3, 0.0, 1e-7, 0.4, 0.9}) EXPECT_NEAR(sine.derivative(t), std::cos(t), tolerance) << t;
}

TEST(TimeFunction, DerivativeAtTheStartUsesNoNegativeTimes) {
  EXPECT_TRUE(std::isfinite(TimeFunction::parse("sqrt(t)*t").derivative(0)));
  EXPECT_NEAR(TimeFunction::parse("t < 0 ? 1/0 : 3*t").derivative(0), 3, 1e-9);
}

TEST(TimeFunction, MayBeNotFinite) {
  EXPECT_FALSE(std::isfinite(TimeFunction::parse("1/t")(0)));
}

TEST(TimeFunction, DoesNotDependOnTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(TimeFunction::parse("0.5*t")(1), 0.5);
  EXPECT_EQ(TimeFunction::parse("0.5")(1), 0.5);
  EXPECT_EQ(TimeFunction::parse("0:0.5")(1), 0.5);
  EXPECT_EQ(TimeFunction(0.5).text(), "0.5");
  std::locale::global(before);
}

TEST(TimeFunction, RefusesWhatIsNoFunction) {
  expect_error("", "expected an expression of t");
  expect_error("  \n", "expected an expression of t");
  expect_error("2*x", "expected an expression of t");
  expect_error("2*x", "at character 3");
  expect_error("sin(", "'sin('");
  expect_error("t t", "at character 3");
  expect_error("nan", "'nan'");
  expect_error("inf", "'inf'");
  expect_error("1.5abc", "'1.5abc'");
  expect_error("1, 2", "several values");
  expect_error("t = 3", "== compares");
  expect_error("\"text\"", "expected an expression");
  expect_error(std::string("t\0+1", 4), "zero byte");
}

TEST(TimeFunction, RefusesBadTables) {
  expect_error("0:0 1:5x", "'1:5x'");
  expect_error("0:0 1", "'1'");
  expect_error("0:0 1:nan", "'1:nan'");
  expect_error("0:0 0:1", "strictly increasing");
  expect_error("1:0 0:1", "strictly increasing");
  expect_error(":", "':'");
}

TEST(TimeFunction, RefusesAbsurdLength) {
  expect_error(std::string(100000, '('), "expected at most");
  expect_error(std::string(3000000, ':'), "expected at most");
  EXPECT_LT(parse_error(std::string(1900, 'x')).size(), 1000u);
}
