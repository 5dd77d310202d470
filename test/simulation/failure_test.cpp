// Tests the explanation of a failed step: what failed, where, and what usually helps.
#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using Reason = StepResult::Reason;
using Quantity = StepResult::Failure::Quantity;

StepResult first_failure(Simulation& simulation, double until) {
  StepResult result = simulation.step();
  while (result.converged && simulation.time() < until) result = simulation.step();
  return result;
}

void expect_says(const Simulation& simulation, const StepResult& result, const std::string& part) {
  const std::string text = simulation.explain(result);
  EXPECT_NE(text.find(part), std::string::npos) << "expected '" << part << "' in: " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

/// An arm of four elements, clamped.
SceneBuilder clamped_arm() {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 4, 2);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  return b;
}

TEST(Failure, StepThatConvergesNeedsNoExplanation) {
  Simulation simulation(clamped_arm().scene);
  const StepResult result = simulation.step();
  ASSERT_TRUE(result.converged);
  EXPECT_EQ(simulation.explain(result), "");
  EXPECT_FALSE(result.failure.place.is_known());
}

TEST(Failure, LoadThatIsNotFiniteIsFoundAtItsElement) {
  SceneBuilder b = clamped_arm();
  b.load("arm", {0.5, 0, 0}, {0, 0, 1}, Vector3::Zero(), "t < 0.55 ? 1 : sqrt(-1)");
  b.scene.integrator.step = 0.1;
  Simulation simulation(b.scene);
  const StepResult result = first_failure(simulation, 1);
  ASSERT_EQ(result.reason, Reason::NotFinite);
  EXPECT_EQ(result.failure.place.element, 1) << "the second of four ends at the load";
  EXPECT_NEAR(result.failure.place.position.x(), 0.5, 0.1);
  EXPECT_DOUBLE_EQ(result.failure.time, simulation.time());
  EXPECT_DOUBLE_EQ(result.failure.step, std::ldexp(0.1, -14));
  EXPECT_EQ(result.failure.guesses, 3);
  expect_says(simulation, result, "a quantity is not finite: a force at element 2 of 4 of link 'arm'");
  expect_says(simulation, result, "14 halvings");
  expect_says(simulation, result, "look at their functions of time");
}

TEST(Failure, FastRotorIsNamedWithItsRotation) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"shaft", 0, 100, {}});
  b.scene.integrator.step = 0.1;
  b.scene.integrator.max_halvings = 2;
  Simulation simulation(b.scene);
  const StepResult result = simulation.step();
  ASSERT_EQ(result.reason, Reason::RotationTooLarge);
  EXPECT_EQ(result.failure.quantity, Quantity::Rotation);
  // The exact rotation is 2.5 rad. The tangent-scaled rule turns by this angle instead.
  EXPECT_NEAR(result.failure.amount, 2 * std::atan(0.5 * 100 * 0.025), 1e-6);
  expect_says(simulation, result, "link 'rotor'");
}

TEST(Failure, ElementBentBeyondItsInterpolationIsNamed) {
  SceneBuilder b;
  // A moment grows slowly and bends each element so far that its nodes no longer show by how much.
  b.beam("arm", {{1, 0, 0}}, section(1e5, 3.5e4, 0.8, 1, 1, 2e-5, 1e-5), 2, 2);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, Vector3::Zero(), {0, 9 * kPi, 0}, "(1 - cos(_pi*min(t, 20)/20))/2");
  b.scene.gravity.setZero();
  b.scene.integrator.step = 0.02;
  b.scene.integrator.max_halvings = 5;
  Simulation simulation(b.scene);
  const StepResult result = first_failure(simulation, 20);
  ASSERT_EQ(result.reason, Reason::BentTooFar) << simulation.explain(result);
  EXPECT_EQ(result.failure.quantity, Quantity::Bending);
  // The interpolation is unique up to half a turn on either side of the middle node, 2 pi in all.
  EXPECT_NEAR(result.failure.amount, 2 * kPi, 0.1 * kPi);
  expect_says(simulation, result, "of 2 of link 'arm'");
  expect_says(simulation, result, "a finer mesh of that link: 4 elements or more");
}

TEST(Failure, LoopDrivenBeyondItsReachIsAtADeadPoint) {
  SceneBuilder b;
  // A four-bar linkage: the crank points 0.8 m upwards, the coupler leads to (0.6, 0, 0.8), and the rocker of 0.6 m
  // stands on (0.6, 0, 0.2). When coupler and rocker are in line, the crank's end is 1.2 m from the rocker's foot. The
  // crank is driven further.
  const Matrix3 inertia = 0.05 * Matrix3::Identity();
  b.body("crank", 1, {0, 0, 0.4}, inertia);
  b.body("coupler", 1, {0.3, 0, 0}, inertia);
  b.body("rocker", 1, {0, 0, 0.3}, inertia);
  b.joint("crank", JointKind::Continuous, "world", "crank", {0, 0, 0}, {0, 1, 0});
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0, 0, 0.8}, {0, 1, 0});
  b.joint("foot", JointKind::Continuous, "world", "rocker", {0.6, 0, 0.2}, {0, 1, 0});
  close_loop(b, "hip", JointKind::Continuous, "rocker", "coupler", {0.6, 0, 0}, {0, 1, 0});
  b.scene.motions.push_back({"crank", TimeFunction::parse("3*t*t/(1+t)"), {}});
  b.scene.gravity.setZero();
  b.scene.integrator.step = 0.002;
  Simulation simulation(b.scene);
  const StepResult result = first_failure(simulation, 2);
  ASSERT_EQ(result.reason, Reason::DeadPoint) << simulation.explain(result);
  expect_says(simulation, result, "loop joint 'hip'");
}

// When a hinge is driven by nearly a full turn, its nodes look as if they had turned back by a small angle.
TEST(Failure, DrivenHingeThatTurnsByNearlyATurnIsNamed) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.scene.motions.push_back({"shaft", TimeFunction::parse("620*t"), {}});
  b.scene.integrator.step = 0.01;
  b.scene.integrator.max_halvings = 0;
  Simulation coarse(b.scene);
  const StepResult result = coarse.step();
  ASSERT_EQ(result.reason, Reason::RotationTooLarge);
  expect_says(coarse, result, "joint coordinate 'shaft'");
  b.scene.integrator.max_halvings = 2;
  Simulation halved(b.scene);
  EXPECT_TRUE(halved.step().converged);
}

// Most scenes with a singular tangent are refused when the model is built (singular_starts_test), so the result is made
// by hand.
TEST(Failure, SingularTangentAsksForACheck) {
  const Simulation simulation(clamped_arm().scene);
  StepResult result;
  result.reason = Reason::SingularTangent;
  expect_says(simulation, result, "flexarm check");
}

}  // namespace
}  // namespace flexarm::test
