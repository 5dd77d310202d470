// Tests that the summary of a run warns of everything that makes results doubtful.
#include "flexarm/simulation/run_summary.h"

#include <cmath>

#include "support/runs.h"
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

/// Warnings of a straight beam of two elements, each of which a moment at the tip bends or twists by this angle:
/// EI = GJ = 1, so that the curvature is the moment.
std::vector<std::string> warnings_of_turned_beam(const Vector3& angle) {
  SceneBuilder b;
  b.beam("strip", {{1, 0, 0}}, section(1e5, 1e5, 1, 1, 1, 0.02, 0.01), 2, 2);
  b.joint("clamp", JointKind::Fixed, "world", "strip");
  b.load("strip", {1, 0, 0}, {0, 0, 0}, 2 * angle);
  b.scene.gravity.setZero();
  Simulation simulation(b.scene);
  EXPECT_TRUE(simulation.solve_static(20).converged);
  return RunSummary(simulation).warnings(simulation);
}

// The bound is 2.1 rad, where the compliance of an evenly bent element is wrong by about 3 %.
TEST(RunSummary, ElementsThatAreBentFarAreNamed) {
  EXPECT_TRUE(warnings_of_turned_beam({0, 0, 2}).empty());
  EXPECT_TRUE(warnings_of_turned_beam({3, 0, 0}).empty()) << "torsion that is even makes no error";
  const std::vector<std::string> warnings = warnings_of_turned_beam({0, 0, 2.5});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(" of 2 of link 'strip' was bent by up to 2.5 rad, at t = 0 s"), std::string::npos)
      << warnings[0];
  EXPECT_NE(warnings[0].find("or refine=\"true\""), std::string::npos) << warnings[0];
}

// A light rod that flies is wound up by moments at its ends. Four elements take up a third more work than they should;
// halved ones are never bent that far.
TEST(RunSummary, ElementsThatWindUpDuringARunAreNamed) {
  for (const bool refines : {false, true}) {
    SceneBuilder b;
    scene::BeamDescription& beam = b.beam("rod", {{1, 0, 0}}, section(1e5, 1e5, 0.08, 0.1, 0.12, 2e-7, 1e-7), 4, 2);
    beam.stiffness_proportional_damping = 0.002;
    beam.refine = refines;
    b.joint("flight", JointKind::Floating, "world", "rod");
    b.load("rod", {1, 0, 0}, {0, 0, 0}, {0, -3, 0}, "sin(62.83185307179586*t)^2");
    b.load("rod", {0, 0, 0}, {0, 0, 0}, {0, 1.8, 0}, "sin(62.83185307179586*t)^2");
    b.scene.gravity.setZero();
    b.scene.integrator.step = 2e-4;
    Simulation simulation(b.scene);
    std::string told;
    for (const std::string& warning : warnings_after(simulation, 200)) told += warning + "\n";
    const bool is_named = told.find(" of 4 of link 'rod' was bent by up to ") != std::string::npos;
    EXPECT_EQ(is_named, !refines) << told;
  }
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
  // reuse would converge to round-off
  Simulation simulation(b.scene, full_newton());
  const std::vector<std::string> warnings = warnings_after(simulation, 40);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings.back().find("energy - work + dissipation changed"), std::string::npos) << warnings.back();
}

}  // namespace
}  // namespace flexarm::test
