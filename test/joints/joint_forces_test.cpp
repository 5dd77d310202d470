// Tests passive efforts on coordinates: damping and friction. joint_stop_test.cpp tests stops.
#include "joints/joint_forces.h"

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "joints/coordinate_steps.h"

namespace flexarm {
namespace {

using namespace test;

double passive_slope_by_difference(const Coordinate& coordinate, const CoordinateStep& change, double scale) {
  return slope_by_difference([&](const CoordinateStep& moved) { return passive_effort(coordinate, moved).effort; },
                             change, scale);
}

TEST(PassiveEffort, DampingAndFriction) {
  Coordinate coordinate;
  coordinate.damping = 0.7;
  coordinate.friction = 1.3;
  const double h = 0.01;
  for (const double rate : {-1.0, -2e-3, -1e-4, 0.0, 3e-4, 1e-3, 0.5})
    for (const double gamma : {1.0, 0.5, 0.6}) {
      CoordinateStep change = step_between(0.2, 0.2 + rate * h, h);
      change.increment = rate * h;
      change.gamma = gamma;
      change.begin_rate = gamma == 1.0 ? 123.0 : rate;  // has no influence on the mean rate
      const PassiveEffort effort = passive_effort(coordinate, change);
      EXPECT_NEAR(effort.effort, -0.7 * rate - 1.3 * std::tanh(rate / kFrictionSpeed), 1e-12);
      EXPECT_GE(effort.dissipated, 0);
      EXPECT_NEAR(effort.dissipated, -effort.effort * change.increment, 1e-15);
      const double scale = kFrictionSpeed * h * gamma;  // size of an increment over which friction changes
      EXPECT_NEAR(effort.slope, passive_slope_by_difference(coordinate, change, scale), 1e-9 / scale);
    }
}

// Friction falls from its value at rest to that of fast sliding.
TEST(PassiveEffort, StribecksCurve) {
  Coordinate coordinate;
  coordinate.friction = 1.3;
  coordinate.static_ratio = 1.5;
  coordinate.stribeck_speed = 0.02;
  const double h = 0.01;
  for (const double rate : {-1.0, -0.03, -0.01, 0.0, 4e-3, 0.02, 0.5})
    for (const double gamma : {1.0, 0.6}) {
      CoordinateStep change = step_between(0.2, 0.2 + rate * h, h);
      change.increment = rate * h;
      change.gamma = gamma;
      change.begin_rate = gamma == 1.0 ? 123.0 : rate;
      const double rise = 1 + 0.5 * std::exp(-rate * rate / 4e-4);
      EXPECT_NEAR(friction_rise(coordinate, change).value, rise, 1e-13);
      const PassiveEffort effort = passive_effort(coordinate, change);
      EXPECT_NEAR(effort.effort, -1.3 * rise * std::tanh(rate / kFrictionSpeed), 1e-12);
      EXPECT_GE(effort.dissipated, 0);
      const double scale = kFrictionSpeed * h * gamma;
      EXPECT_NEAR(effort.slope, passive_slope_by_difference(coordinate, change, scale), 1e-9 / scale);
    }
}

TEST(PassiveEffort, NoneInStatics) {
  Coordinate coordinate;
  coordinate.damping = coordinate.friction = 1;
  const PassiveEffort effort = passive_effort(coordinate, step_between(0, 0, 0));
  EXPECT_EQ(effort.effort, 0);
  EXPECT_EQ(effort.slope, 0);
  EXPECT_EQ(effort.dissipated, 0);
}

}  // namespace
}  // namespace flexarm
