// Tests that a simulation continues from the state of another simulation with other settings.
#include <cmath>

#include "simulation/everything_scene.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

Simulation after_steps(const scene::SceneDescription& scene, int steps) {
  Simulation simulation(scene);
  run(simulation, steps);
  return simulation;
}

/// Expects equal positions and velocities, bit for bit.
void expect_same_motion(const Simulation& a, const Simulation& b) {
  EXPECT_EQ(a.time(), b.time());
  for (std::size_t i = 0; i < a.coordinate_names().size(); ++i)
    EXPECT_EQ(a.position(i), b.position(i)) << a.coordinate_names()[i];
  const State &left = state_of(a), &right = state_of(b);
  ASSERT_EQ(left.nodes.size(), right.nodes.size());
  for (std::size_t i = 0; i < left.nodes.size(); ++i) {
    EXPECT_EQ(left.nodes[i].position, right.nodes[i].position);
    EXPECT_EQ(left.nodes[i].orientation.coeffs(), right.nodes[i].orientation.coeffs());
    EXPECT_EQ(left.nodes[i].velocity, right.nodes[i].velocity);
    EXPECT_EQ(left.nodes[i].angular_velocity, right.nodes[i].angular_velocity);
  }
}

TEST(TakeOver, OfTheSameSettingsIsACopy) {
  Simulation from = after_steps(driven_scene().scene, 50);
  Simulation to(driven_scene().scene);
  to.take_over(from);
  run(from, 50), run(to, 50);
  // Kept factors of the tangent are not part of a state, so the motions agree only to within Newton's tolerance.
  for (std::size_t i = 0; i < from.coordinate_names().size(); ++i)
    EXPECT_NEAR(to.position(i), from.position(i), 1e-6) << from.coordinate_names()[i];
}

TEST(TakeOver, OtherSchemesAndStepsGoOnWithoutAJump) {
  scene::SceneDescription scene = driven_scene().scene;
  for (const char* before : {"em", "newmark", "hht1", "edmc2"})
    for (const char* after : {"em", "m1", "newmark", "hht1", "hht3", "edmc2"})
      for (const double factor : {1.0, 0.5}) {
        scene.integrator = with_scheme(scene.integrator, before);
        scene::SceneDescription other = scene;
        other.integrator = with_scheme(scene.integrator, after);
        other.integrator.step *= factor;
        Simulation from = after_steps(scene, 40), to(other);
        from.apply_wrenches({{1, Vector3::Zero(), {{0, 0, 0.01}, Vector3::Zero()}, false}});
        to.take_over(from);
        SCOPED_TRACE(std::string(before) + " to " + after + " by " + std::to_string(factor));
        expect_same_motion(to, from);
        EXPECT_NEAR(energy_account(to), energy_account(from), 1e-9 * (1 + std::abs(energy_account(from))));
        EXPECT_EQ(state_of(to).wrenches.size(), 1u);
        run(to, 20);
        EXPECT_NO_THROW(to.restore(to.snapshot()));
        to.reset();
        ASSERT_TRUE(to.step().converged) << "the scene's own start is there, too";
      }
}

TEST(TakeOver, GravityAndGainsAreTheOtherOnes) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitZ());
  scene::ServoDescription servo;
  servo.coordinate = "rail";
  servo.kp = 400;
  servo.kd = 80;
  b.scene.servos.push_back(servo);
  b.scene.gravity = {0, 0, -10};
  Simulation from = after_steps(b.scene, 3000);
  EXPECT_NEAR(from.position(0), -20.0 / 400, 1e-6);
  b.scene.servos[0].kp = 1000;
  b.scene.gravity = {0, 0, -5};
  Simulation to(b.scene);
  to.take_over(from);
  EXPECT_EQ(to.position(0), from.position(0));
  EXPECT_NEAR(energy_account(to), energy_account(from), 1e-9);
  run(to, 5000);
  EXPECT_NEAR(to.position(0), -10.0 / 1000, 1e-6);
}

TEST(TakeOver, PullsThatTheSchemeDoesNotHaveAreRefused) {
  scene::SceneDescription scene = driven_scene().scene;
  Simulation from = after_steps(scene, 5);
  from.apply_wrenches({{1, Vector3::Zero(), {}, false, {Vector3(1, 0, 0), 10, 1}}});
  scene.integrator = with_scheme(scene.integrator, "hht1");
  Simulation to(scene);
  EXPECT_THROW(to.take_over(from), std::invalid_argument);
  EXPECT_EQ(to.time(), 0);
  scene.integrator = with_scheme(scene.integrator, "newmark");
  EXPECT_NO_THROW(Simulation(scene).take_over(from));
}

TEST(TakeOver, AnotherMechanismIsRefused) {
  Simulation simulation(driven_scene().scene);
  const State before = state_of(simulation);
  EXPECT_THROW(simulation.take_over(Simulation(rubbing_scene().scene)), std::invalid_argument);
  EXPECT_EQ(state_of(simulation).time, before.time);
  EXPECT_TRUE(simulation.step().converged);
}

}  // namespace
}  // namespace flexarm::test
