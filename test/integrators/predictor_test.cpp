// Tests which extrapolation the predictor chooses for the first guess of a step.
#include <limits>

#include <gtest/gtest.h>

#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

constexpr double kStep = 0.01;

Simulation after_some_steps(const SceneBuilder& builder) {
  SimulationOptions options;
  options.scheme = "em";
  options.step = kStep;
  Simulation simulation(builder.scene, options);
  for (int n = 0; n < 10; ++n) EXPECT_TRUE(simulation.step().converged);
  return simulation;
}

// A parabola is predicted to round-off, so that the first update is only round-off.
TEST(Predictor, ForeseesFreeFall) {
  SceneBuilder builder;
  builder.body("ball", 2, Vector3::Zero(), Matrix3::Identity());
  builder.joint("flight", scene::JointKind::Floating, "world", "ball", Vector3::Zero());
  builder.scene.gravity = {0, 0, -9.81};
  builder.scene.initial_links.push_back({"ball", {1, 2, 3}, Vector3::Zero(), {}});
  const Simulation simulation = after_some_steps(builder);
  EXPECT_GE(state_of(simulation).history.order, 1);
  // The position is about 1 m: 64 roundings. Repeating the last velocity would be wrong by g h^2 = 1e-3.
  EXPECT_LT(update_norms_of(simulation).front(), 64 * std::numeric_limits<double>::epsilon());
}

// A mode that is far too fast for the step changes its sign from step to step. Extrapolation would amplify it, and
// repeating the last increment has the wrong sign. So the guess is the configuration at the beginning.
TEST(Predictor, StandsWhereMotionChangesItsSign) {
  SceneBuilder builder;
  builder.beam("bar", {{1, 0, 0}}, section(1e8, 1e8, 1e2, 1e2, 1, 0.01, 0.01), 1, 1);
  builder.joint("clamp", scene::JointKind::Fixed, "world", "bar", Vector3::Zero());
  builder.scene.gravity.setZero();
  builder.scene.initial_links.push_back({"bar", {1, 0, 0}, Vector3::Zero(), {}});
  EXPECT_EQ(state_of(after_some_steps(builder)).history.order, IncrementHistory::kNoMotion);
}

}  // namespace
}  // namespace flexarm::test
