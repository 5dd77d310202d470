// Tests Grips, joints that press with a limited effort.
#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "scene/scene_builder.h"
#include "stepping/grips.h"

namespace flexarm::node {
namespace {

constexpr double kStop = 0.05, kMaxEffort = 12;  ///< [m], [N]

/// A finger with a stop.
scene::SceneDescription finger(double kp, double ki) {
  scene::SceneBuilder b("finger");
  b.scene.integrator.step = 1e-3;
  b.scene.gravity.setZero();
  b.body("finger", 0.2, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("slide", scene::JointKind::Prismatic, "world", "finger").limits = scene::JointLimits{-kStop, kStop, 0, {}};
  scene::ServoDescription servo;
  servo.coordinate = "slide";
  servo.kp = kp;
  servo.kd = 40;
  servo.ki = ki;
  b.scene.servos.push_back(servo);
  return b.scene;
}

void run(Grips& grips, Simulation& simulation, double duration) {
  const double end = simulation.time() + duration;
  while (simulation.time() < end) {
    grips.command(simulation);
    ASSERT_TRUE(simulation.step().converged);
  }
}

TEST(Grips, PressWithTheirEffortAndNoMore) {
  for (const double ki : {0.0, 4000.0})
    for (const double side : {1.0, -1.0}) {
      Simulation simulation(finger(2000, ki));
      Grips grips;
      grips.close(0, side * 0.2, kMaxEffort);
      run(grips, simulation, 3);
      EXPECT_NEAR(simulation.effort(0), side * kMaxEffort, 1e-3 * kMaxEffort) << ki;
      EXPECT_NEAR(simulation.position(0), side * kStop, 1e-3);
      grips.close(0, side * 0.01, kMaxEffort);  // no wound-up integral holds it there
      run(grips, simulation, 1.5);
      EXPECT_NEAR(simulation.position(0), side * 0.01, 2e-4) << ki;
    }
}

TEST(Grips, WithoutALimitTheServoGivesWhatItGives) {
  Simulation simulation(finger(2000, 0));
  Grips grips;
  grips.close(0, 0.2, 0);
  run(grips, simulation, 1);
  EXPECT_GT(simulation.effort(0), 2000 * (0.2 - kStop) * 0.9);
}

TEST(Grips, LeaveReleasedJointsAlone) {
  Simulation simulation(finger(2000, 0));
  Grips grips;
  grips.close(0, 0.02, kMaxEffort);
  EXPECT_TRUE(grips.holds(0));
  grips.release(0);
  EXPECT_FALSE(grips.holds(0));
  run(grips, simulation, 0.1);
  EXPECT_EQ(simulation.position(0), 0);
}

TEST(Grips, WantAGainToLimit) {
  EXPECT_EQ(Grips::refusal_of_limit(Simulation(finger(2000, 0)), 0), "");
  EXPECT_EQ(Grips::refusal_of_limit(Simulation(finger(0, 10)), 0),
            "the servo of 'slide' has no kp, so that its effort cannot be limited");
}

}  // namespace
}  // namespace flexarm::node
