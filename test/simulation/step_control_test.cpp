// Tests halving, recovery and failure of steps: a step either succeeds or leaves the last good state.
#include <cmath>

#include <gtest/gtest.h>

#include "flexarm/schemes/integrator_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A rotor that turns by more than a quarter turn in a step, until its damper has slowed it down.
SceneBuilder fast_rotor(double speed, double damping) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Vector3(1, 1, 1).asDiagonal());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1}).damping = damping;
  b.scene.initial_joints.push_back({"shaft", 0, speed, {}});
  b.scene.integrator.step = 0.1;
  return b;
}

bool is_finite(const State& state) {
  for (const NodeState& node : state.nodes)
    if (!node.position.allFinite() || !node.orientation.coeffs().allFinite() || !node.velocity.allFinite() ||
        !node.angular_velocity.allFinite())
      return false;
  for (const Released& released : state.released)
    if (!released.displacement.allFinite() || !released.rotation.coeffs().allFinite()) return false;
  return std::isfinite(state.time) && std::isfinite(state.work) && std::isfinite(state.dissipated);
}

TEST(StepControl, HalvesAndRecoversToTheFullStep) {
  Simulation simulation(fast_rotor(45, 0.3).scene);
  StepResult result = simulation.step();
  ASSERT_TRUE(result.converged);
  EXPECT_GE(result.halvings, 2) << "4.5 rad in a step";
  EXPECT_NEAR(simulation.time(), 0.1, 1e-15);
  int late_halvings = 0;
  for (int n = 1; n < 100; ++n) {
    result = simulation.step();
    ASSERT_TRUE(result.converged);
    EXPECT_NEAR(simulation.time(), 0.1 * (n + 1), 1e-12) << "whole steps stay on their grid";
    if (n > 90) late_halvings += result.halvings;
  }
  EXPECT_EQ(late_halvings, 0);
  EXPECT_EQ(state_of(simulation).halving_level, 0);
  EXPECT_EQ(state_of(simulation).steps, 100);
}

TEST(StepControl, FailureLeavesTheLastGoodState) {
  SceneBuilder b = fast_rotor(1000, 0);
  b.scene.integrator.max_halvings = 2;
  Simulation simulation(b.scene);
  const StepResult result = simulation.step();
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason, StepResult::Reason::None);
  EXPECT_EQ(result.halvings, 2);
  EXPECT_DOUBLE_EQ(simulation.time(), 0);
  EXPECT_TRUE(is_finite(state_of(simulation)));
  EXPECT_DOUBLE_EQ(simulation.velocity(0), 1000);
  // The step fails again in the same way, also after a reset. The state stays valid.
  EXPECT_FALSE(simulation.step().converged);
  simulation.reset();
  EXPECT_FALSE(simulation.step().converged);
  EXPECT_TRUE(is_finite(state_of(simulation)));
}

TEST(StepControl, NonFiniteLoadFailsWithoutSpoilingTheState) {
  for (const std::string_view name : scheme_names()) {
    const std::string scheme(name);
    SceneBuilder b;
    if (find_scheme(name)->tableau) {
      b.body("arm", 1, {0.5, 0, 0}, Matrix3::Identity());
      b.joint("hinge", JointKind::Continuous, "world", "arm");
    } else {
      b.beam("arm", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 2, 2);
      b.joint("clamp", JointKind::Fixed, "world", "arm");
    }
    b.load("arm", {1, 0, 0}, {0, 0, 1}, Vector3::Zero(), "t < 0.55 ? 1 : sqrt(-1)");
    b.scene.integrator.step = 0.1;
    b.scene.integrator.scheme = scheme;
    Simulation simulation(b.scene);
    for (int n = 0; n < 5; ++n) ASSERT_TRUE(simulation.step().converged) << scheme;
    const StepResult result = simulation.step();
    EXPECT_FALSE(result.converged) << scheme;
    EXPECT_EQ(result.reason, StepResult::Reason::NotFinite) << to_string(result.reason);
    EXPECT_TRUE(is_finite(state_of(simulation))) << scheme;
    EXPECT_GE(simulation.time(), 0.5 - 1e-12);
    EXPECT_LE(simulation.time(), 0.55);
    EXPECT_TRUE(std::isfinite(simulation.energies().total()));
  }
}

TEST(StepControl, StaticFailureLeavesTheStateUntouched) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 2, 2);
  b.joint("free", JointKind::Floating, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 0, 1});
  b.probe("tip", "arm", {1, 0, 0});
  Simulation simulation(b.scene);
  const Vector3 before = simulation.probe(0).pose.position;
  EXPECT_FALSE(simulation.solve_static(1).converged) << "a free beam has no equilibrium under a force";
  EXPECT_EQ(simulation.probe(0).pose.position, before);
  EXPECT_TRUE(is_finite(state_of(simulation)));
}

// Arithmetic with subnormal numbers would make a step ten times as slow.
TEST(StepControl, SubnormalNumbersAreZeros) {
  SceneBuilder b;
  b.body("ball", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("free", scene::JointKind::Floating, "world", "ball");
  b.scene.gravity.setZero();
  b.scene.initial_links.push_back({"ball", {1e-310, 0, 0}, Vector3::Zero(), {}});
  b.probe("center", "ball", Vector3::Zero());
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_EQ(simulation.probe(0).pose.position.x(), 0);
}

}  // namespace
}  // namespace flexarm::test
