/// Tests cam profiles (eccentric discs and periodic tables): derivatives, secants with round-off accuracy, bad tables.
#include "flexarm/math/cam_profile.h"
#include "math/pi.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

CamProfile table() {
  return CamProfile::periodic({0.3, 1.0, 2.2, 3.0, 4.4, 5.9}, {0.1, 0.4, 0.2, -0.3, 0.05, -0.1});
}

class CamProfiles : public ::testing::TestWithParam<CamProfile> {};

/// Central difference of fourth order: its error is below 1e-10 for profiles of order one.
double difference(const std::function<double(double)>& f, double u) {
  const double h = 1e-3;
  return (8 * (f(u + h) - f(u - h)) - (f(u + 2 * h) - f(u - 2 * h))) / (12 * h);
}

TEST_P(CamProfiles, DerivativesAndPeriod) {
  const CamProfile& profile = GetParam();
  for (double u = -9; u < 9; u += 0.37) {
    EXPECT_NEAR(profile.derivative(u), difference([&](double x) { return profile.value(x); }, u), 1e-9) << u;
    EXPECT_NEAR(profile.second_derivative(u), difference([&](double x) { return profile.derivative(x); }, u), 1e-9)
        << u;
    EXPECT_NEAR(profile.value(u + 2 * kPi), profile.value(u), 1e-14);
  }
}

// secant * change equals the travel to within its round-off, for any change and across knots.
TEST_P(CamProfiles, SecantGivesTheTravel) {
  const CamProfile& profile = GetParam();
  for (double from = -7; from < 7; from += 0.31)
    for (const double change : {2.5, 0.7, 1e-2, 9e-4, 1e-5, 1e-8, 1e-12, -1e-12, -1e-6, -5e-4, -0.3, -3.0}) {
      const double to = from + change, secant = profile.secant(from, to);
      EXPECT_NEAR(secant * (to - from), profile.value(to) - profile.value(from), 4e-16) << from << " " << change;
      // The secant is symmetric. It equals the slope in the middle, up to a term of curvature times change squared.
      EXPECT_NEAR(secant, profile.secant(to, from), 1e-12);
      EXPECT_NEAR(secant, profile.derivative(0.5 * (from + to)), 2 * change * change + 1e-11);
    }
  EXPECT_NEAR(profile.secant(0.7, 0.7), profile.derivative(0.7), 1e-15);
}

TEST_P(CamProfiles, SecantDerivative) {
  const CamProfile& profile = GetParam();
  for (double from = -7; from < 7; from += 0.31)
    for (const double change : {1.1, 0.05, -0.4}) {
      const double expected = difference([&](double x) { return profile.secant(from, x); }, from + change);
      EXPECT_NEAR(profile.secant_derivative(from, from + change), expected, 1e-8) << from << " " << change;
    }
  EXPECT_NEAR(profile.secant_derivative(0.7, 0.7), 0.5 * profile.second_derivative(0.7), 1e-15);
}

// The derivative of a secant is half the second derivative plus a third of its change, up to the square of the change,
// 1e-10.
TEST_P(CamProfiles, SecantDerivativeOverTinyChanges) {
  const CamProfile& profile = GetParam();
  for (double from = -7; from < 7; from += 0.31)
    for (const double change : {9e-6, -9e-6}) {
      const double begin = profile.second_derivative(from), end = profile.second_derivative(from + change);
      EXPECT_NEAR(profile.secant_derivative(from, from + change), 0.5 * begin + (end - begin) / 3, 1e-10) << from;
    }
}

TEST(CamProfile, ShortSecantsOverAKnot) {
  const CamProfile profile = table();
  const double round_off = 1e-15 / 5e-4;  // round-off of values, divided by the change
  for (const double knot : {0.3, 1.0, 2.2, 3.0, 4.4, 5.9})
    for (const double change : {5e-4, -5e-4}) {
      const double from = knot - 0.4 * change, to = from + change;
      EXPECT_NEAR(profile.secant(from, to), (profile.value(to) - profile.value(from)) / change, round_off) << knot;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CamProfiles, ::testing::Values(CamProfile::eccentric(0.4, 0.1), table()));

TEST(CamProfile, EccentricTravel) {
  const CamProfile profile = CamProfile::eccentric(0.5, 0.2);
  EXPECT_EQ(profile.value(0), -0.2);
  EXPECT_NEAR(profile.value(kPi), -(2 * 0.5 + 0.2), 1e-15);
}

TEST(CamProfile, TableIsInterpolatedSmoothly) {
  const CamProfile profile = table();
  EXPECT_NEAR(profile.value(1.0), 0.4, 1e-15);
  EXPECT_NEAR(profile.value(5.9 - 2 * kPi), -0.1, 1e-14);
  for (const double knot : {0.3, 1.0, 2.2, 3.0, 4.4, 5.9}) {
    const double h = 1e-9;
    EXPECT_NEAR(profile.derivative(knot - h), profile.derivative(knot + h), 1e-7);
    EXPECT_NEAR(profile.second_derivative(knot - h), profile.second_derivative(knot + h), 1e-7);
  }
}

TEST(CamProfile, BadTables) {
  const auto message = [](const std::vector<double>& angles, const std::vector<double>& travels) {
    try {
      CamProfile::periodic(angles, travels);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({0, 1}, {0, 1}), "a profile needs at least three points");
  EXPECT_EQ(message({0, 1, 2}, {0, 1}), "a profile needs a travel for every angle");
  EXPECT_EQ(message({0, 2, 1}, {0, 1, 0}), "angles must increase");
  EXPECT_EQ(message({0, 1, 7}, {0, 1, 0}), "angles must span less than 2 pi: the profile repeats itself after a turn");
  EXPECT_EQ(message({0, 1, NAN}, {0, 1, 0}), "numbers must be finite");
}

TEST(CamProfile, EccentricDiscsAreFinite) {
  EXPECT_THROW(CamProfile::eccentric(NAN, 0), std::invalid_argument);
  EXPECT_THROW(CamProfile::eccentric(0.1, INFINITY), std::invalid_argument);
}

}  // namespace
}  // namespace flexarm
