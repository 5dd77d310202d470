// Tests LastSteps::rate_at_end(), which computes published rates at the end of a step from increments over the last
// steps.
#include "simulation/published_motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "math/so3.h"

namespace flexarm {
namespace {

constexpr double kRoundOff = 64 * std::numeric_limits<double>::epsilon();

using Rate = Eigen::Matrix<double, 1, 1>;

/// Rate of a scalar position x(t) at `end`, from steps of these lengths, the newest first.
template <class Position>
double rate(const Position& x, double end, const std::array<double, 5>& lengths, int count = 5) {
  LastSteps steps;
  steps.count = count;
  steps.length = lengths;
  LastSteps::MeanRates<1> mean;
  for (int k = 0; k < 5; ++k) {
    mean[k][0] = (x(end) - x(end - lengths[k])) / lengths[k];
    end -= lengths[k];
  }
  return steps.rate_at_end<1>(mean)[0];
}

double cubic(double t) {
  return 1 + t * (2 + t * (3 + 0.5 * t));
}
double cubic_rate(double t) {
  return 2 + t * (6 + 1.5 * t);
}

TEST(RateAtEnd, IsExactForCubicsOverAnySteps) {
  for (const std::array<double, 5>& lengths :
       {std::array<double, 5>{0.1, 0.1, 0.1, 0.1, 0.1}, {0.1, 0.2, 0.05, 0.1, 0.2}, {0.2, 0.1, 0.1, 0.05, 0.1}})
    for (const int count : {3, 4, 5})
      EXPECT_NEAR(rate(cubic, 2, lengths, count), cubic_rate(2), kRoundOff * cubic(2) / 0.05);
  // Lengths as in a composed step, whose third part runs backwards.
  EXPECT_NEAR(rate(cubic, 2, {0.0414, 0.0414, -0.0658, 0.0414, 0.0414}), cubic_rate(2),
              4 * kRoundOff * cubic(2) / 0.0171);
}

TEST(RateAtEnd, IsExactForParabolasAfterTwoSteps) {
  const auto parabola = [](double t) { return 1 + t * (2 + 3 * t); };
  EXPECT_NEAR(rate(parabola, 2, {0.1, 0.2, 0.1, 0.1, 0.1}, 2), 14, kRoundOff * parabola(2) / 0.1);
}

TEST(RateAtEnd, IsTheMeanAfterAJump) {
  // A body at rest is thrown: only the mean rate of the last step is usable.
  const auto thrown = [](double t) { return t < 0 ? 0 : 2 * t; };
  EXPECT_NEAR(rate(thrown, 0.1, {0.1, 0.1, 0.1, 0.1, 0.1}), 2, kRoundOff * 2);
  // A body that comes to a steady motion or to rest: the rate equals the last two mean rates, whatever was before.
  LastSteps steps;
  steps.length = {0.5, 0.5, 0.5, 0.5, 0.5};
  for (const int count : {3, 4, 5})
    for (const double speed : {2.0, 0.0}) {
      steps.count = count;
      EXPECT_EQ(steps.rate_at_end<1>({Rate(speed), Rate(speed), Rate(1), Rate(1), Rate(1)})[0], speed);
    }
  // If a force jumps in the last step but one, half of its effect on the mean rate is in each of two steps. This must
  // not be extrapolated as an acceleration.
  EXPECT_EQ(steps.rate_at_end<1>({Rate(1.5), Rate(0.5), Rate(0), Rate(0), Rate(0)})[0], 1.5);
}

/// An oscillation whose mean rates have the amplitude 1 is not amplified in the result.
TEST(RateAtEnd, DoesNotAmplifyWhatRings) {
  const auto ringing = [](double t) { return 0.05 * std::cos(kPi * t / 0.1); };  // mean rates +-1
  for (const double end : {1.0, 1.1})
    EXPECT_NEAR(std::abs(rate(ringing, end, {0.1, 0.1, 0.1, 0.1, 0.1})), 1, kRoundOff / 0.1);
}

/// A body at rest is accelerated from an instant on, with the part `share` of a step left. Only the mean rate of the
/// last step is usable until four steps are behind that one. Waves that grow do not look like an extremum either.
TEST(RateAtEnd, IsNotExtrapolatedAcrossAJump) {
  LastSteps steps;
  steps.count = 5;
  steps.length = {0.1, 0.1, 0.1, 0.1, 0.1};
  for (const double share : {0.1, 0.5, 0.9}) {
    const double first = 0.5 * share * share;
    const auto mean = [&](int step) { return Rate(step < 1 ? 0 : step == 1 ? first : step - 1.5 + share); };
    for (int last = 1; last <= 3; ++last)
      EXPECT_EQ(steps.rate_at_end<1>({mean(last), mean(last - 1), mean(last - 2), mean(last - 3), mean(last - 4)})[0],
                mean(last)[0])
          << share << ", " << last;
  }
  EXPECT_EQ(steps.rate_at_end<1>({Rate(3), Rate(1), Rate(0), Rate(0), Rate(0)})[0], 3);
  // But an extremum of a smooth rate is extrapolated, here of 1 - t^2.
  const auto turning = [](double t) { return t - t * t * t / 3; };
  for (const double end : {-0.1, 0.0, 0.05, 0.13, 0.2, 0.3, 0.4})
    EXPECT_NEAR(rate(turning, end, {0.1, 0.1, 0.1, 0.1, 0.1}), 1 - end * end, kRoundOff / 0.1) << end;
}

/// The rate is of third order where the motion is smooth, also at extrema of the rate and where it does not change.
TEST(RateAtEnd, Order) {
  const auto worst = [](double step, double from, double to) {
    double error = 0;
    for (double t = from; t < to; t += 0.37 * step)
      error = std::max(
          error, std::abs(rate([](double s) { return std::sin(s); }, t, {step, step, step, step, step}) - std::cos(t)));
    return error;
  };
  EXPECT_NEAR(std::log2(worst(0.02, 0.5, 2.5) / worst(0.01, 0.5, 2.5)), 3, 0.1);
  EXPECT_NEAR(std::log2(worst(0.02, -0.5, 0.5) / worst(0.01, -0.5, 0.5)), 3, 0.1);
  EXPECT_NEAR(std::log2(worst(0.02, -4, 4) / worst(0.01, -4, 4)), 3, 0.1);
}

TEST(RateAtEnd, TurnsWithTheAxes) {
  const Matrix3 turn = so3::exp(Vector3(0.3, -1.1, 0.7));
  LastSteps steps;
  steps.count = 5;
  steps.length = {0.1, 0.2, 0.1, 0.1, 0.1};
  LastSteps::MeanRates<3> smooth{Vector3(1, 2, 3), Vector3(1.1, 1.5, 2.4), Vector3(1.2, 1.1, 2.0),
                                 Vector3(1.3, 0.8, 1.7), Vector3(1.4, 0.6, 1.5)},
      rough{Vector3(1, 2, 3), Vector3(0.4, 3, -1), Vector3(0.1, 3.5, 1), Vector3(0, 3, 0), Vector3(1, 1, 1)};
  for (const LastSteps::MeanRates<3>& mean : {smooth, rough}) {
    LastSteps::MeanRates<3> turned;
    for (int k = 0; k < 5; ++k) turned[k] = turn * mean[k];
    EXPECT_LT((steps.rate_at_end<3>(turned) - turn * steps.rate_at_end<3>(mean)).norm(), kRoundOff * 10);
  }
}

}  // namespace
}  // namespace flexarm
