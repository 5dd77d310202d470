// Tests the measurement of the real-time factor, which is simulated time per wall time.
#include "ros/real_time_factor.h"

#include <gtest/gtest.h>

namespace flexarm::node {
namespace {

using std::chrono::milliseconds;

const RealTimeFactor::Clock::time_point kStart;
constexpr double kRoundOff = 1e-12;

TEST(RealTimeFactor, IsSimulatedPerWallTimeSinceTheMeasurementBefore) {
  RealTimeFactor factor(kStart);
  EXPECT_NEAR(factor.measure(0.1, kStart + milliseconds(100), false), 1, kRoundOff);
  EXPECT_NEAR(factor.measure(0.15, kStart + milliseconds(200), false), 0.5, kRoundOff);
}

TEST(RealTimeFactor, RepeatsTheLastMeasurementWhereTheNextWouldBeTooShort) {
  RealTimeFactor factor(kStart);
  factor.measure(0.1, kStart + milliseconds(100), false);
  // Ten steps at once, then a reset that forces a status: 10 ms of simulated time in 1 ms.
  EXPECT_NEAR(factor.measure(0.11, kStart + milliseconds(101), false), 1, kRoundOff);
  // The next measurement contains the time that was not measured then.
  EXPECT_NEAR(factor.measure(0.2, kStart + milliseconds(200), false), 1, kRoundOff);
}

TEST(RealTimeFactor, IsZeroWhilePausedAndDoesNotCountThePause) {
  RealTimeFactor factor(kStart);
  factor.measure(0.1, kStart + milliseconds(100), false);
  EXPECT_EQ(factor.measure(0.1, kStart + milliseconds(110), true), 0);
  EXPECT_EQ(factor.measure(0.1, kStart + milliseconds(9900), false), 0);
  EXPECT_NEAR(factor.measure(0.2, kStart + milliseconds(10000), false), 1, kRoundOff);
}

}  // namespace
}  // namespace flexarm::node
