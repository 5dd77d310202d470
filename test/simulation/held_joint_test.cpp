// Tests a joint with a constant prescribed motion: it has no unknown, and reports the effort that holds it.
#include <gtest/gtest.h>

#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kAngle = 0.4;

/// Three links. The second one stands at an angle to the first, either by a constant motion or by a fixed joint.
SceneBuilder arm(bool is_fixed) {
  SceneBuilder b;
  const Matrix3 inertia = Vector3(0.02, 0.03, 0.01).asDiagonal();
  for (const char* name : {"upper", "middle", "lower"}) b.body(name, 1.5, {0, 0, 0.2}, inertia);
  b.joint("first", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  scene::JointDescription& elbow =
      b.joint("elbow", is_fixed ? JointKind::Fixed : JointKind::Revolute, "upper", "middle", {0, 0, 0.4}, {0, 1, 0});
  if (is_fixed)
    elbow.origin.orientation = Eigen::AngleAxisd(kAngle, Vector3::UnitY());
  else
    b.scene.motions.push_back({"elbow", TimeFunction(kAngle), {}});
  b.joint("last", JointKind::Revolute, "middle", "lower", {0, 0, 0.4}, {0, 0.8, 0.6});
  b.scene.initial_joints.push_back({"first", 0.3, 2, {}, true});
  b.scene.initial_joints.push_back({"last", -0.5, 1, {}, true});
  b.sensor("elbow", scene::SensorKind::Wrench, "middle");
  b.probe("tip", "lower", {0, 0, 0.4});
  b.scene.gravity = {0, 0, -9.81};
  return b;
}

class HeldJoint : public ::testing::TestWithParam<const char*> {};

TEST_P(HeldJoint, HasNoUnknownAndTellsWhatHoldsIt) {
  SceneBuilder held_scene = arm(false), fixed_scene = arm(true);
  held_scene.scene.integrator.scheme = fixed_scene.scene.integrator.scheme = GetParam();
  held_scene.scene.integrator.tolerance = fixed_scene.scene.integrator.tolerance = 1e-12;
  Simulation held(held_scene.scene), fixed(fixed_scene.scene);
  EXPECT_EQ(held.degrees_of_freedom(), fixed.degrees_of_freedom());
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(held.step().converged);
    ASSERT_TRUE(fixed.step().converged);
  }
  EXPECT_EQ(held.position(1), kAngle);
  EXPECT_EQ(held.velocity(1), 0);
  // The sensor has the axes and the origin of the joint. Both results have errors of second order, for links that turn
  // by 5 rad/s.
  EXPECT_NEAR(held.effort(1), held.sample(0).values[4], 25 * std::pow(held.step_size(), 2));
  EXPECT_GT(std::abs(held.effort(1)), 0.1);
  EXPECT_LT((held.probe(0).pose.position - fixed.probe(0).pose.position).norm(), 1e-9);
  // The effort that holds the joint does no work.
  EXPECT_NEAR(held.energies().work, 0, 1e-12);
}

// A sensor of the reaction at a fixed link gives the link a node of its own, and does not change the motion.
TEST(FixedJoint, MovesTheSameWithASensor) {
  const SceneBuilder with = arm(true);
  SceneBuilder without = with;
  without.scene.sensors.clear();
  Simulation a(with.scene), b(without.scene);
  EXPECT_NEAR(a.energies().kinetic, b.energies().kinetic, 1e-13 * b.energies().kinetic);
  EXPECT_LT((a.angular_momentum() - b.angular_momentum()).norm(), 1e-13 * b.angular_momentum().norm());
}

INSTANTIATE_TEST_SUITE_P(Schemes, HeldJoint, ::testing::Values("em", "em4", "edmc2", "newmark"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace flexarm::test
