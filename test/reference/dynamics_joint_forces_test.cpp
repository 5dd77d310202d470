// Tests efforts in joints against closed forms: damping, friction, stops, motors, mimics and prescribed motions.
#include "joints/joint_forces.h"
#include "reference/one_coordinate_scenes.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

TEST(JointDamping, DecaysExponentially) {
  SceneBuilder b = block_on_rail(0, 3);
  b.scene.joints[0].damping = 4;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int steps = 100 << k;
    Simulation simulation(b.scene, options("em", 1.0 / steps));
    run(simulation, steps);
    error[k] = std::abs(simulation.velocity(0) - 3 * std::exp(-4 / kBlockMass));
  }
  EXPECT_LT(error[1], 1e-3);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
}

TEST(JointFriction, SlidesWithConstantDeceleration) {
  SceneBuilder b = block_on_rail(0, 2);
  b.scene.joints[0].friction = 3;
  Simulation simulation(b.scene, options("em", 0.01));
  run(simulation, 100);
  // While it slides, tanh(v / 1 mm/s) is 1 to round-off.
  EXPECT_NEAR(simulation.velocity(0), 2 - 3 / kBlockMass, 1e-9);
  EXPECT_NEAR(simulation.energies().dissipated, 3 * simulation.position(0), 1e-9);
  run(simulation, 200);  // would stop at 4/3 s
  EXPECT_NEAR(simulation.velocity(0), 0, 1e-3);
  EXPECT_NEAR(simulation.position(0), 0.5 * kBlockMass * 4 / 3, 0.01) << "stopping distance m v^2 / 2 F";
}

TEST(JointFriction, SticksBelowItsLimit) {
  SceneBuilder b = block_on_rail(0, 0);
  b.scene.joints[0].friction = 3;
  Simulation simulation(b.scene, options("em", 0.01));
  simulation.command_effort(0, 2.4);
  run(simulation, 500);
  // With the smooth law it creeps at v_s atanh(F / F_c).
  EXPECT_NEAR(simulation.position(0), 5 * 1e-3 * std::atanh(0.8), 1e-4);
  simulation.command_effort(0, 4);
  const double before = simulation.velocity(0);
  run(simulation, 100);
  EXPECT_NEAR(simulation.velocity(0) - before, (4 - 3) / kBlockMass, 5e-3) << "slides above it";
}

double restitution(const SceneBuilder& builder, double step, double speed) {
  Simulation simulation(builder.scene, options("em", step));
  double after = speed;
  for (int n = 0; n < 20000 && after > 0; ++n) {
    EXPECT_TRUE(simulation.step().converged);
    after = simulation.velocity(0);
  }
  // Continues until the block has left the stop.
  for (int n = 0; n < 200; ++n) {
    EXPECT_TRUE(simulation.step().converged);
    after = std::min(after, simulation.velocity(0));
  }
  return -after / speed;
}

// The documented restitution 0.3 is that of the continuous impact. Ten steps resolve it to a few per cent.
TEST(JointLimit, ReboundsWithTheDocumentedRestitution) {
  for (const double speed : {0.2, 2.0}) {
    SceneBuilder b = block_on_rail(0, speed);
    b.scene.joints[0].limits = scene::JointLimits{-1, 0.5};
    EXPECT_NEAR(restitution(b, 1e-3, speed), 0.3, 0.02) << speed;
  }
  SceneBuilder b = wheel_on_shaft(3);
  b.scene.joints[0].limits = scene::JointLimits{-1, 0.5};
  EXPECT_NEAR(restitution(b, 1e-3, 3), 0.3, 0.02);
}

TEST(JointLimit, HoldsAgainstAnEffort) {
  SceneBuilder b = block_on_rail(0, 0);
  b.scene.joints[0].limits = scene::JointLimits{-1, 0.01};
  Simulation simulation(b.scene, options("em", 1e-3));
  simulation.command_effort(0, 5);
  double deepest = 0;
  run(simulation, 2000, [&] { deepest = std::max(deepest, simulation.position(0)); });
  EXPECT_NEAR(simulation.velocity(0), 0, 1e-6);
  const scene::JointLimits limits = *b.scene.joints[0].limits;
  const double stiffness = model_of(simulation).coordinates[0].limit->stiffness;
  EXPECT_NEAR(simulation.position(0), limits.upper + 5 / stiffness, 1e-6) << "rests where the penalty balances it";
}

TEST(JointMotor, EffortSaturatesAtItsLimit) {
  SceneBuilder b = block_on_rail(0, 0);
  b.scene.joints[0].limits = scene::JointLimits{-100, 100};
  b.scene.joints[0].effort_limit = 3;
  Simulation simulation(b.scene, options("em", 0.01));
  simulation.command_effort(0, 10);
  run(simulation, 100);
  EXPECT_DOUBLE_EQ(simulation.effort(0), 3);
  EXPECT_NEAR(simulation.velocity(0), 3 / kBlockMass, 1e-9);
  simulation.command_effort(0, -10);
  run(simulation, 100);
  EXPECT_DOUBLE_EQ(simulation.effort(0), -3);
  EXPECT_NEAR(simulation.velocity(0), 0, 1e-9);
}

TEST(JointMotor, EffortHistoryGivesItsImpulse) {
  SceneBuilder b = wheel_on_shaft(0);
  b.scene.efforts.push_back({"shaft", TimeFunction::parse("0:0 1:5 2:0"), {}});
  Simulation simulation(b.scene, options("em", 0.01));
  run(simulation, 200);
  // The tangent-scaled rotation increment differs from the angle by (w h)^2 / 12. The energy balance is not affected.
  const double speed = 5 / kWheelInertia;
  EXPECT_NEAR(simulation.velocity(0), speed, speed * std::pow(speed * 0.01, 2) / 12);
  EXPECT_NEAR(simulation.energies().work, simulation.energies().kinetic, 1e-10 * simulation.energies().kinetic);
}

TEST(JointMimic, FollowsToRoundOffAndSharesTheInertia) {
  SceneBuilder b;
  const double ratio = -2.5, offset = 0.3;
  b.body("one", 1, {0, 0, 0}, Vector3(1, 1, 0.2).asDiagonal());
  b.body("two", 1, {0, 0, 0}, Vector3(1, 1, 0.1).asDiagonal());
  b.joint("master", JointKind::Revolute, "world", "one", {0, 0, 0}, {0, 0, 1});
  b.joint("follower", JointKind::Revolute, "world", "two", {1, 0, 0}, {0, 0, 1}).mimic =
      scene::Mimic{"master", ratio, offset};
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  ASSERT_EQ(simulation.degrees_of_freedom(), 1u);
  EXPECT_FALSE(simulation.is_commandable(1));
  simulation.command_effort(0, 2);
  run(simulation, 200, [&] {
    ASSERT_NEAR(simulation.position(1), ratio * simulation.position(0) + offset,
                1e-13 * (1 + std::abs(simulation.position(1))));
  });
  // Equation (J_1 + ratio^2 J_2) u'' = Q, up to the tangent scaling of rotation increments of up to 0.12 rad.
  const double speed = 2 * 2.0 / (0.2 + ratio * ratio * 0.1), scaling = std::pow(ratio * speed * 0.01, 2) / 12;
  EXPECT_NEAR(simulation.velocity(1), ratio * simulation.velocity(0), scaling * std::abs(ratio) * speed);
  EXPECT_NEAR(simulation.velocity(0), speed, scaling * speed);
}

// A pendulum driven along theta(t) needs the torque J theta'' + m g a sin(theta). It is compared from the third step
// on.
TEST(PrescribedMotion, FollowsItsFunctionAndBalancesInverseDynamics) {
  const double mass = 1.5, arm = 0.4, about_center = 0.2, amplitude = 0.8, rate = 3;
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("pendulum", mass, {0, 0.1, -arm}, Vector3(1, about_center, 1).asDiagonal());
  b.joint("drive", JointKind::Revolute, "world", "pendulum", {0, 0, 0}, {0, 1, 0});
  b.scene.motions.push_back({"drive", TimeFunction::parse("0.8*(1-cos(3*t))"), {}});
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const double step = 0.01 / (1 << k);
    Simulation simulation(b.scene, options("em", step));
    EXPECT_EQ(simulation.degrees_of_freedom(), 0u);
    EXPECT_FALSE(simulation.is_commandable(0));
    error[k] = 0;
    run(simulation, 200 << k, [&] {
      ASSERT_NEAR(simulation.position(0), amplitude * (1 - std::cos(rate * simulation.time())), 1e-14);
      if (state_of(simulation).steps < 3) return;
      const double phase = rate * simulation.time();
      const double angle = amplitude * (1 - std::cos(phase)), acceleration = amplitude * rate * rate * std::cos(phase);
      const double torque = (about_center + mass * arm * arm) * acceleration + mass * 9.81 * arm * std::sin(angle);
      error[k] = std::max(error[k], std::abs(simulation.effort(0) - torque));
    });
  }
  EXPECT_LT(error[1], 5e-3);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2);
}

TEST(PrescribedMotion, DrivesAFlexibleArmWithBalancedEnergy) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, scene::DirectSection{1e4, 5e3, 5e3, 20, 20, 20, 1, 0.02, 0.01, 0.01}, 2, 2);
  b.joint("hub", JointKind::Revolute, "world", "arm", {0, 0, 0}, {0, 0, 1});
  b.scene.motions.push_back({"hub", TimeFunction::parse("t^2"), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-11));
  run(simulation, 200, [&] {
    const Energies e = simulation.energies();
    ASSERT_NEAR(e.total(), e.work, 1e-10 * (1 + e.total()));
    ASSERT_NEAR(simulation.position(0), simulation.time() * simulation.time(), 1e-13);
  });
  EXPECT_GT(simulation.energies().total(), 1);
}

}  // namespace
}  // namespace flexarm::test
