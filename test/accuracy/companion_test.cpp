// Tests the companion of a simulation, which estimates the error of a run while it goes on, against finer runs.
#include "flexarm/accuracy/companion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "accuracy/falling_arm.h"
#include "math/pi.h"

namespace flexarm::test {
namespace {

TEST(Companion, KnowsTheErrorOfWhatRuns) {
  const SceneBuilder b = falling_arm();
  constexpr int kSteps = 300;
  constexpr double kStep = 0.004;
  Simulation simulation(b.scene), reference(b.scene);
  simulation.set_step_size(kStep);
  reference.set_step_size(kStep / 16);
  Companion companion(simulation);
  double estimate = std::nan(""), error = 0;
  for (int n = 0; n < kSteps; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
    EXPECT_EQ(std::isnan(estimate), n == 0);
    for (int k = 0; k < 16; ++k) ASSERT_TRUE(reference.step().converged);
    error = std::max(error, (simulation.probe(0).pose.position - reference.probe(0).pose.position).norm());
  }
  EXPECT_NEAR(estimate, error, 0.3 * error);
}

/// Efforts that change from step to step have the same impulse in the companion's steps. So the exact error is known
/// for a mass.
TEST(Companion, FollowsCommands) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  Simulation simulation(b.scene);
  Companion companion(simulation);
  double estimate = 0;
  for (int n = 0; n < 200; ++n) {
    simulation.command_effort(0, std::sin(0.3 * n));
    simulation.apply_wrenches({{1, Vector3::Zero(), {{0.1 * n, 0, 0}, Vector3::Zero()}, false}});
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
  }
  // The acceleration changes once in a step of the companion, whose mean moves the position by h^2 / 2 times this
  // change.
  const double change = 0.5 * (0.3 + 0.1) / 2 * 1e-6;
  EXPECT_GT(estimate, 0);
  EXPECT_LE(estimate, 100 * change / 3);
}

/// Largest estimate, and largest distance of a block on a rail from its exact position.
struct Judged {
  double estimate = 0, error = 0;
};
template <class Position>
Judged follow_block(const SceneBuilder& b, double until, const Position& position) {
  Simulation simulation(b.scene);
  Companion companion(simulation);
  Judged out;
  for (int n = std::lround(until / simulation.step_size()); n > 0; --n) {
    EXPECT_TRUE(simulation.step().converged);
    const double estimate = companion.follow(simulation);
    if (!std::isnan(estimate)) out.estimate = estimate;
    out.error = std::max(out.error, std::abs(simulation.position(0) - position(simulation.time())));
  }
  return out;
}

SceneBuilder block_at(double position, double velocity) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  b.scene.initial_joints.push_back({"rail", position, velocity, {}});
  b.scene.gravity = Vector3::Zero();
  b.scene.integrator.step = 0.01;
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

// An effort that jumps from 6 N to -6 N anywhere in a step: 3 m/s^2 for 2 kg. So the velocity after the step is off by
// at most 6 m/s^2 h/2.
TEST(Companion, CountsJumpsWithinItsSteps) {
  const double h = 0.01, until = 1;
  for (int k = 0; k < 16; ++k) {
    const double jump = 0.3 + h * k / 7.5 + 1e-6;
    SceneBuilder b = block_at(0, 0);
    b.scene.efforts.push_back({"rail", TimeFunction::parse("t < " + std::to_string(jump) + " ? 6 : -6"), {}});
    const Judged judged = follow_block(b, until, [&](double t) {
      return t < jump ? 1.5 * t * t : 1.5 * jump * jump + 3 * jump * (t - jump) - 1.5 * (t - jump) * (t - jump);
    });
    const double bound = 0.5 * 6 * h * (until - jump);
    EXPECT_GE(judged.estimate, judged.error) << jump;
    EXPECT_LE(judged.error, 1.1 * bound) << jump;
    EXPECT_LE(judged.estimate, 2.2 * bound) << jump;  // includes the companion's own error
  }
}

// The push is smaller than friction. The block comes to rest after v^2/(2 a) and stays there.
TEST(Companion, CountsWhereFrictionBringsToRest) {
  for (const double start : {0.3, 0.317, 0.335, 0.349}) {
    SceneBuilder b = block_at(0, start);
    b.scene.joints[0].friction = 2;
    b.scene.joints[0].friction_law.law = scene::FrictionDescription::Law::Coulomb;
    const Judged judged = follow_block(b, 1, [&](double t) {
      const double s = std::min(t, start / 1.0);
      return start * s - 0.5 * s * s;
    });
    EXPECT_GE(judged.estimate, judged.error) << start;
    EXPECT_LE(judged.estimate, 1.0 * 0.01) << "a velocity of 1 m/s^2 h for a second" << start;
  }
}

// A motor at its limit until the error is small, then a spring: 4 m/s^2 until 0.1 m are left, then 40/s^2 times the
// remaining distance.
TEST(Companion, CountsWhereAMotorLeavesItsLimit) {
  for (const double target : {0.5, 0.513, 0.527, 0.541}) {
    SceneBuilder b = block_at(0, 0);
    scene::ServoDescription& servo = b.servo("rail", 80, 0, 0);
    servo.set_point = TimeFunction(target);
    servo.effort_limit = 8;
    const double free = std::sqrt(2 * (target - 0.1) / 4), rate = 4 * free, w = std::sqrt(40.0);
    // Ends before the limit on the other side
    const double until = free + 0.9 * (kPi - 2 * std::atan2(rate / w, 0.1)) / w;
    const Judged judged = follow_block(b, std::floor(until / 0.02) * 0.02, [&](double t) {
      return t < free ? 2 * t * t : target - 0.1 * std::cos(w * (t - free)) + rate / w * std::sin(w * (t - free));
    });
    EXPECT_GE(judged.estimate, judged.error) << target;
  }
}

// If features that may cause corners cause none, the estimate is the same as without these features.
TEST(Companion, NoCornerNoDoubt) {
  SceneBuilder plain = falling_links(), with = falling_links();
  with.scene.joints[0].limits = scene::JointLimits{-3, 3};
  with.scene.efforts.push_back({"elbow", TimeFunction(0.0), {}});
  std::array<double, 2> estimates{};
  for (std::size_t i = 0; i < 2; ++i) {
    Simulation simulation((i == 0 ? plain : with).scene);
    Companion companion(simulation);
    for (int n = 0; n < 300; ++n) {
      ASSERT_TRUE(simulation.step().converged);
      estimates[i] = companion.follow(simulation);
    }
  }
  EXPECT_NEAR(estimates[0] / estimates[1], 1, 1e-6);
}

// A corner in the first steps gives no estimate.
TEST(Companion, SaysWhatItDoesNotKnow) {
  SceneBuilder b = block_at(0, 0);
  b.scene.efforts.push_back({"rail", TimeFunction::parse("t < 0.014 ? 6 : -6"), {}});
  Simulation simulation(b.scene);
  Companion forever(simulation), windowed(simulation, 0.2);
  double estimate = 0;
  for (int n = 0; n < 50; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    if (n >= 4) {
      EXPECT_TRUE(std::isnan(forever.follow(simulation))) << n;
    } else {
      forever.follow(simulation);
    }
    estimate = windowed.follow(simulation);
  }
  EXPECT_FALSE(std::isnan(estimate)) << "another window has begun";
}

TEST(Companion, BeginsAgainWhereTheSimulationIsPut) {
  Simulation simulation(falling_arm().scene);
  Companion companion(simulation, 0.05);
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    companion.follow(simulation);
  }
  simulation.reset();
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_TRUE(std::isnan(companion.follow(simulation)));
  ASSERT_TRUE(simulation.step().converged);
  companion.follow(simulation);
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_LT(companion.follow(simulation), 1e-6) << "a step or two are nearly exact";
}

TEST(Companion, RefusesAWindowOfNoLength) {
  const Simulation simulation(falling_arm().scene);
  for (const double window : {0.0, -1.0, double(NAN)})
    EXPECT_THROW(Companion(simulation, window), std::invalid_argument) << window;
}

}  // namespace
}  // namespace flexarm::test
