// Natural modes of mechanisms whose frequencies are known in closed form or by counting.
#include "flexarm/solver/modes.h"

#include <gtest/gtest.h>

#include "flexarm/model/model_builder.h"
#include "flexarm/simulation/observables.h"
#include "support/scene_builder.h"

namespace flexarm {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;

TEST(NaturalModes, PendulumAboutItsEquilibrium) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("bob", 2.0, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 1);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].frequency, std::sqrt(2.0 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25)) / (2 * kPi), 1e-9);
}

TEST(NaturalModes, InvertedPendulumGrows) {
  SceneBuilder builder;
  builder.scene.gravity = Vector3(0, 0, -9.81);
  builder.body("bob", 2.0, Vector3(0, 0, 0.5), 0.1 * Matrix3::Identity());
  builder.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 1);
  EXPECT_NEAR(modes.at(0).frequency, -std::sqrt(2.0 * 9.81 * 0.5 / (0.1 + 2.0 * 0.25)) / (2 * kPi), 1e-9);
}

// A free beam has six rigid motions, and every node of a motion moves.
TEST(NaturalModes, FreeBeamHasSixRigidMotions) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0)}, section(1e4, 4e3, 5, 8, 1, 1e-3, 5e-4), 4, 3);
  builder.joint("free", scene::JointKind::Floating, "world", "beam");
  const Model model = build_model(builder.scene);
  const std::vector<Mode> modes = natural_modes(model, initial_state(model), 8);
  ASSERT_EQ(modes.size(), 8u);
  // Zero up to round-off of the largest frequencies kept, in squares.
  for (int k = 0; k < 6; ++k) EXPECT_LE(std::abs(modes[k].frequency), 1e-3 * modes[6].frequency) << k;
  EXPECT_GT(modes[6].frequency, 1);
  for (const Mode& mode : modes) {
    double largest = 0;
    for (const Vector6& motion : mode.node_motion) largest = std::max(largest, motion.cwiseAbs().maxCoeff());
    EXPECT_NEAR(largest, 1, 1e-12);
  }
}

TEST(NaturalModes, NothingMovesOrNothingAsked) {
  SceneBuilder builder;
  builder.body("block", 2.0, Vector3::Zero(), Matrix3::Identity());
  builder.joint("glue", scene::JointKind::Fixed, "world", "block");
  const Model fixed = build_model(builder.scene);
  EXPECT_TRUE(natural_modes(fixed, initial_state(fixed), 3).empty());
  SceneBuilder pendulum;
  pendulum.body("bob", 2.0, Vector3(0, 0, -0.5), 0.1 * Matrix3::Identity());
  pendulum.joint("hinge", scene::JointKind::Continuous, "world", "bob", Vector3::Zero(), Vector3::UnitY());
  const Model model = build_model(pendulum.scene);
  EXPECT_TRUE(natural_modes(model, initial_state(model), 0).empty());
  EXPECT_EQ(natural_modes(model, initial_state(model), 5).size(), 1u);  // no more than there are
}

}  // namespace
}  // namespace flexarm
