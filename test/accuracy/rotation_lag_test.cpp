// Tests how much free rotation lags: the closed forms of two schemes, and that it stays below an accuracy.
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "flexarm/accuracy/accurate_run.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// A rotor on a shaft without loads, with a probe at a distance of 1 m.
SceneBuilder free_rotor(double rate) {
  SceneBuilder b;
  b.body("rotor", 1, {0.2, 0, 0}, Vector3(0.02, 0.03, 0.04).asDiagonal());
  b.joint("shaft", scene::JointKind::Continuous, "world", "rotor", Vector3::Zero(), Vector3::UnitZ());
  b.probe("rim", "rotor", {1, 0, 0});
  b.scene.initial_joints.push_back({"shaft", 0, rate, {}});
  b.scene.gravity.setZero();
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

/// The angle by which the rotor turns in one step of 1 s.
double turn_of(const std::string& scheme, double rate) {
  SceneBuilder b = free_rotor(rate);
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = 1;
  Simulation simulation(b.scene);
  EXPECT_TRUE(simulation.step().converged);
  return simulation.position(0);
}

double lag(double turn) {
  return turn - 2 * std::atan(0.5 * turn);
}

// docs/notes/beyond.md 1.4
TEST(RotationLag, HasItsClosedForms) {
  const double part = 1 / (4 - std::cbrt(4.0));
  for (const double rate : {0.25, 0.5, 1.0}) {
    EXPECT_NEAR(rate - turn_of("em", rate), lag(rate), 1e-11);
    EXPECT_NEAR(rate - turn_of("em4", rate), 4 * lag(part * rate) + lag((1 - 4 * part) * rate), 1e-11);
  }
}

// The first tries turn the rotor by up to 6 rad in a step.
TEST(RotationLag, StaysBelowAnAccuracy) {
  constexpr double kUntil = 2, kAccuracy = 1e-3;
  for (const double rate : {3.0, 30.0, 300.0}) {
    Simulation simulation(free_rotor(rate).scene);
    RunWatcher nobody;
    const AccurateRun run = run_to_accuracy(simulation, {kAccuracy, kUntil}, nobody);
    ASSERT_EQ(run.end, AccurateRun::End::Met) << rate << ": " << to_string(run.end);
    const double lag = rate * kUntil - simulation.position(0);
    EXPECT_GT(lag, 0);
    // The probe is 1 m away from the shaft, and its largest displacement is the diameter.
    EXPECT_LE(2 * std::sin(0.5 * lag), 2 * kAccuracy) << rate;
  }
}

}  // namespace
}  // namespace flexarm::test
