// Tests springs with play, and motors behind rigid and elastic gears, over one step: work, slopes, laws.
#include "joints/motor_step.h"

#include <gtest/gtest.h>

#include "joints/coordinate_steps.h"
#include "joints/elasticity.h"
#include "joints/joint_forces.h"
#include "joints/servo_step.h"

namespace flexarm {
namespace {

using namespace test;

const Elasticity kGear{300, 0.7, 0.02};
constexpr double kStep = 0.01;

TEST(Elasticity, WorkIsWhatLeavesTheEnergyLessWhatIsDissipated) {
  for (const double backlash : {0.0, 0.02})
    for (const double from : {-0.03, -0.01, -0.004, 0.0, 0.006, 0.01, 0.05})
      for (const double to : {-0.05, -0.01, -0.0099, 0.0, 0.01 + 1e-9, 0.03}) {
        const Elasticity gear{300, 0.7, backlash};
        const PassiveEffort effort = elastic_effort(gear, step_between(from, to, kStep));
        const double energy = elastic_energy(gear, to) - elastic_energy(gear, from);
        EXPECT_NEAR(effort.effort * (to - from), -energy - effort.dissipated, 1e-15) << from << " " << to;
        EXPECT_GE(effort.dissipated, 0);
      }
}

TEST(Elasticity, SlopeByDifferences) {
  for (const bool at_end : {false, true})
    for (const double from : {-0.03, 0.002, 0.02})
      for (const double to : {-0.04, 0.004, 0.025}) {
        CoordinateStep twist = step_between(from, to, kStep);
        twist.at_end = at_end;
        if (at_end) twist.gamma = 0.6, twist.begin_rate = 0.3;
        const double slope = slope_by_difference(
            [](const CoordinateStep& moved) { return elastic_effort(kGear, moved).effort; }, twist, 1e-3);
        const PassiveEffort effort = elastic_effort(kGear, twist);
        EXPECT_NEAR(effort.slope, slope, 1e-8 * kGear.stiffness) << from << " " << to;
        EXPECT_LE(effort.slope, 0);
      }
}

TEST(Elasticity, NothingWithinThePlay) {
  const PassiveEffort effort = elastic_effort(kGear, step_between(-0.009, 0.008, kStep));
  EXPECT_EQ(effort.effort, 0);
  EXPECT_EQ(effort.slope, 0);
  EXPECT_EQ(effort.dissipated, 0);
}

/// A rotor in a step of the midpoint rule, from rest or from a rate.
RotorStep rotor_step(double angle, double rate) {
  RotorStep rotor;
  rotor.change = step_between(angle, angle, kStep);
  rotor.rate_offset = -rate;
  rotor.rate_slope = 2 / kStep;
  rotor.acceleration_offset = -2 * rate / kStep;
  rotor.acceleration_slope = 2 / (kStep * kStep);
  return rotor;
}

struct MotorCase {
  std::string name;
  Drive drive;
  MotorDemand demand;
};

std::vector<MotorCase> motor_cases() {
  Drive rigid, elastic, tired, rubbing, sticking;
  rigid.inertia = elastic.inertia = 0.05;
  elastic.gear = kGear;
  tired = rubbing = elastic;
  tired.effort_limit = 4, tired.velocity_limit = 3;
  rubbing.friction = 0.3, rubbing.loss = 0.25;
  sticking = rubbing;
  sticking.sticks = true;
  Drive lossy = rigid;
  lossy.loss = 0.25;
  const MotorDemand constant{2, 0, 0}, servo{2, -500, -40};
  return {{"rigid", rigid, servo},         {"lossy", lossy, servo},      {"elastic", elastic, constant},
          {"servo", elastic, servo},       {"tired", tired, {50, 0, 0}}, {"rubbing", rubbing, servo},
          {"sticking", sticking, constant}};
}

TEST(MotorAction, SlopeByDifferences) {
  for (const MotorCase& c : motor_cases())
    for (const double increment : {-0.06, -0.02, 0.03, 0.055}) {
      const RotorStep rotor = rotor_step(0.5, 1.5);
      const CoordinateStep link = step_between(0.49, 0.49 + increment, kStep);
      const auto effort = [&](const CoordinateStep& moved) {
        return motor_action(c.drive, c.demand, rotor, moved, 0).effort;
      };
      const MotorAction action = motor_action(c.drive, c.demand, rotor, link, 0);
      EXPECT_NEAR(action.slope, slope_by_difference(effort, link, 1e-4), 1e-5 * (kGear.stiffness + 1000))
          << c.name << " " << increment;
    }
}

// The change of kinetic and elastic energy equals the motor's work less the work on the coordinate less the
// dissipation.
TEST(MotorAction, AccountsForEnergy) {
  for (const MotorCase& c : motor_cases())
    for (const double rate : {-2.0, 0.0, 3.0})
      for (const double increment : {-0.06, 0.001, 0.055}) {
        const RotorStep rotor = rotor_step(0.5, rate);
        const CoordinateStep link = step_between(0.49, 0.49 + increment, kStep);
        const MotorAction action = motor_action(c.drive, c.demand, rotor, link, 0);
        const double end_rate = rotor.rate_offset + rotor.rate_slope * action.increment;
        double energy = 0.5 * c.drive.inertia * (end_rate * end_rate - rate * rate);
        if (c.drive.gear)
          energy += elastic_energy(kGear, 0.5 + action.increment - link.end) - elastic_energy(kGear, 0.5 - link.begin);
        const double expected = action.motor * action.increment - action.effort * increment - action.dissipated;
        EXPECT_NEAR(energy, expected, 1e-12) << c.name << " " << rate << " " << increment;
        EXPECT_GE(action.dissipated, -1e-15) << c.name;
      }
}

TEST(MotorAction, IsThatOfTheTorqueSpeedLine) {
  Drive drive;
  drive.effort_limit = 4;
  drive.velocity_limit = 3;
  for (const double rate : {-4.0, -3.0, -1.0, 0.0, 1.5, 3.0, 5.0}) {
    const CoordinateStep link = step_between(0, rate * kStep, kStep);
    const auto motor = [&](double asked) {
      return motor_action(drive, {asked, 0, 0}, rotor_step(0, rate), link, 0).motor;
    };
    EXPECT_NEAR(motor(100), 4 * std::clamp(1 - rate / 3, 0.0, 1.0), 1e-14) << "nothing at the no-load speed";
    EXPECT_NEAR(motor(-100), -4 * std::clamp(1 + rate / 3, 0.0, 1.0), 1e-14);
    EXPECT_EQ(motor(0), 0);
  }
}

// A rotor that friction holds stands exactly still, until the effort exceeds friction.
TEST(MotorAction, SticksUntilFrictionIsOvercome) {
  Drive drive;
  drive.inertia = 0.05;
  drive.gear = Elasticity{300, 0, 0};
  drive.friction = 0.5;
  drive.sticks = true;
  const CoordinateStep link = step_between(0, 0, kStep);
  RotorStep rotor = rotor_step(0, 0);
  rotor.rests = true;
  for (const double effort : {-0.49, 0.0, 0.49}) {
    const MotorAction action = motor_action(drive, {effort, 0, 0}, rotor, link, 0.01);
    EXPECT_EQ(action.increment, 0);
    EXPECT_TRUE(action.is_stopped);
  }
  EXPECT_GT(motor_action(drive, {0.51, 0, 0}, rotor, link, 0).increment, 0);
  EXPECT_LT(motor_action(drive, {-0.51, 0, 0}, rotor, link, 0).increment, 0);
  // If friction can take away all of the initial rate, the rotor is at rest at the end of the step.
  rotor = rotor_step(0, 0.05);
  const MotorAction action = motor_action(drive, {0, 0, 0}, rotor, link, 0);
  EXPECT_TRUE(action.is_stopped);
  EXPECT_NEAR(rotor.rate_offset + rotor.rate_slope * action.increment, 0, 1e-15);
}

// In statics, the rotor is where gear and motor are in equilibrium.
TEST(MotorAction, InStatics) {
  Drive drive;
  drive.inertia = 0.05;
  drive.gear = kGear;
  RotorStep rotor;
  rotor.change = step_between(0.1, 0.1, 0);
  const CoordinateStep link = step_between(0.1, 0.3, 0);
  MotorAction action = motor_action(drive, {6, 0, 0}, rotor, link, 0);
  EXPECT_NEAR(action.effort, 6, 1e-12);
  EXPECT_NEAR(action.slope, 0, 1e-9) << "a constant effort has no stiffness";
  EXPECT_NEAR(action.increment, 0.2 + 6 / 300.0 + 0.01, 1e-14);
  // A spring between rotor and ground is in series with the gear.
  action = motor_action(drive, {0, -100, 0}, rotor, link, 0);
  EXPECT_NEAR(action.slope, -1 / (1 / 300.0 + 1 / 100.0), 1e-9);
}

TEST(MotorRange, IsTheTorqueSpeedLine) {
  Drive drive;
  drive.effort_limit = 4, drive.velocity_limit = 2;
  const MotorRange still = motor_range(drive, Drive::kInfinity, 0), turning = motor_range(drive, 3.5, 1);
  EXPECT_EQ(still.lowest, -4);
  EXPECT_EQ(still.highest, 4);
  EXPECT_EQ(turning.lowest, -3.5) << "cut by the controller: what brakes does not lose effort";
  EXPECT_EQ(turning.highest, 2);
}

/// The mean effort of a controller over a step tends to its effort at an instant as the step becomes shorter.
TEST(ServoEffort, IsTheLimitOfShortSteps) {
  for (const ServoMode mode : {ServoMode::Position, ServoMode::Velocity, ServoMode::Effort}) {
    const ServoLaw law{mode, 30, 4, 7, 0.05};
    ServoState state;
    state.integral = 0.3;
    const ServoInstant at{0.8, 0.6, 0.5, -0.2, state.integral, 1.5};
    for (const double h : {1e-3, 1e-5}) {
      ServoInput input;
      input.measured = step_between(at.measured, at.measured, h);
      input.begin_rate = at.rate;
      input.set_point = SetPoint(at.set_point, at.set_point + (mode == ServoMode::Position ? h * at.set_rate : 0));
      input.feedforward = at.feedforward;
      const double increment = h * at.rate;
      const ServoDemand mean = servo_demand(law, state, input);
      const double effort = servo_effort(law, at);
      // Errors and integrals change by less than 1 per second. The means differ by half of this change.
      EXPECT_NEAR(mean.constant + mean.slope * increment, effort, 0.5 * h * (law.proportional + law.integral));
      ServoState after = state;
      advance(law, input, increment, -2, after);
      EXPECT_EQ(integral_at_end(law, input, increment, -2, state), after.integral);
    }
  }
}

TEST(SmoothDirection, IsResolvedByTheRefinement) {
  EXPECT_FALSE(is_coarse_turn(0.1, 0.2, 1000)) << "does not turn";
  EXPECT_TRUE(is_coarse_turn(-0.1, 0.1, 1));
  const double part = 0.1 * kFrictionSpeed;  // also about this fraction of the direction
  EXPECT_FALSE(is_coarse_turn(0, part, 4));
  EXPECT_TRUE(is_coarse_turn(0, part, 6));
}

}  // namespace
}  // namespace flexarm
