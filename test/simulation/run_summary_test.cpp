// Tests that the summary of a run warns of everything that makes results doubtful.
#include "flexarm/simulation/run_summary.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

std::vector<std::string> warnings_after(Simulation& simulation, int steps) {
  RunSummary summary(simulation);
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    EXPECT_TRUE(result.converged);
    summary.count(simulation, result);
    summary.look(simulation);
  }
  EXPECT_EQ(summary.counts().steps, steps);
  return summary.warnings(simulation);
}

Simulation free_hinge(double rotation_per_step) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"shaft", 0, 100 * rotation_per_step, {}});
  b.scene.integrator.step = 0.01;
  b.scene.gravity.setZero();
  return Simulation(b.scene);
}

TEST(RunSummary, NothingIsSaidOfAGoodRun) {
  Simulation simulation = free_hinge(0.2);
  EXPECT_TRUE(warnings_after(simulation, 20).empty());
}

TEST(RunSummary, RotationThatLagsIsNamed) {
  Simulation simulation = free_hinge(1);
  const std::vector<std::string> warnings = warnings_after(simulation, 20);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("link 'rotor'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("0.93 rad in the step"), std::string::npos) << "2 atan(1/2), in: " << warnings[0];
  EXPECT_NE(warnings[0].find("are 7.3 % too slow"), std::string::npos) << "1 - 2 atan(1/2), in: " << warnings[0];
}

// Friction is stiff: with long steps of an explicit scheme the motion gains energy.
TEST(RunSummary, StepsOfAnExplicitSchemeThatAreTooLongAreNamed) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1}).friction = 5;
  b.scene.initial_joints.push_back({"shaft", 0, 0.01, {}});
  b.scene.integrator.step = 0.01;
  b.scene.integrator.scheme = "rk4";
  b.scene.gravity.setZero();
  Simulation simulation(b.scene);
  const std::vector<std::string> warnings = warnings_after(simulation, 20);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("by errors of the explicit scheme"), std::string::npos) << warnings[0];
}

TEST(RunSummary, LargeStrainIsNamed) {
  SceneBuilder b;
  b.beam("rope", {{1, 0, 0}}, section(10, 5, 1, 1, 1, 0.02, 0.01), 4, 2);
  b.joint("clamp", JointKind::Fixed, "world", "rope");
  b.load("rope", {1, 0, 0}, {5, 0, 0});
  b.scene.gravity.setZero();
  Simulation simulation(b.scene);
  const std::vector<std::string> warnings = warnings_after(simulation, 300);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("link 'rope' was strained by up to "), std::string::npos) << warnings[0];
}

TEST(RunSummary, EnergyAccountOfALooseToleranceIsOutOfBounds) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e5, 3.5e4, 0.8, 1, 1, 2e-5, 1e-5), 4, 2);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 0, 0.2}, Vector3::Zero(), "t < 0.5 ? 1 : 0");
  b.scene.gravity.setZero();
  b.scene.integrator.step = 0.05;
  b.scene.integrator.tolerance = 0.05;
  SimulationOptions options;
  options.reuse_factorisation = false;  // reuse would converge to round-off
  Simulation simulation(b.scene, options);
  const std::vector<std::string> warnings = warnings_after(simulation, 40);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings.back().find("energy - work + dissipation changed"), std::string::npos) << warnings.back();
}

}  // namespace
}  // namespace flexarm::test
