// Tests the pacer, which decides when a step is due relative to the wall clock.
#include "stepping/pacer.h"

#include <gtest/gtest.h>

namespace flexarm::node {
namespace {

int make_due_steps(Pacer& pacer) {
  int steps = 0;
  while (pacer.step_due()) {
    pacer.step_done();
    ++steps;
  }
  return steps;
}

TEST(Pacer, KeepsTheRatioOfSimulatedToWallTime) {
  for (const double real_time_factor : {0.1, 1.0, 7.5}) {
    Pacer pacer(0.001, real_time_factor, 0.1);
    int steps = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      pacer.elapse(0.001);
      steps += make_due_steps(pacer);
    }
    EXPECT_NEAR(steps, 1000 * real_time_factor, 1) << real_time_factor;
    EXPECT_EQ(pacer.overruns(), 0u);
  }
}

TEST(Pacer, MakesUpAShortStall) {
  Pacer pacer(0.001, 1, 0.1);
  pacer.elapse(0.0805);
  EXPECT_EQ(make_due_steps(pacer), 80);
  EXPECT_EQ(pacer.overruns(), 0u);
}

TEST(Pacer, DropsAndCountsWhatALongStallLeft) {
  Pacer pacer(0.001, 1, 0.1);
  pacer.elapse(1.0005);
  const int steps = make_due_steps(pacer);
  EXPECT_LE(steps, 100);
  EXPECT_GE(steps, 99);
  EXPECT_EQ(steps + pacer.overruns(), 1000u);
}

TEST(Pacer, WaitsForStepsLongerThanTheCatchUp) {
  Pacer pacer(0.5, 1, 0.1);
  int steps = 0;
  for (int tick = 0; tick < 10010; ++tick) {
    pacer.elapse(0.001);
    steps += make_due_steps(pacer);
  }
  EXPECT_EQ(steps, 20);
  EXPECT_EQ(pacer.overruns(), 0u);
}

TEST(Pacer, AsFastAsPossibleIsAlwaysDueAndNeverLate) {
  Pacer pacer(0.001, 0, 0.1);
  EXPECT_TRUE(pacer.step_due());
  pacer.elapse(100);
  pacer.step_done();
  EXPECT_TRUE(pacer.step_due());
  EXPECT_EQ(pacer.overruns(), 0u);
}

TEST(Pacer, ForgetsTheBacklogWithoutCountingIt) {
  Pacer pacer(0.001, 1, 0.1);
  pacer.elapse(0.05);
  pacer.clear_backlog();
  EXPECT_FALSE(pacer.step_due());
  EXPECT_EQ(pacer.overruns(), 0u);
}

}  // namespace
}  // namespace flexarm::node
