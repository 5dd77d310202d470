// Tests the extent of a scene: the picture in rviz must hold all that the arm can reach.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "pictures/scene_extent.h"
#include "scene/scene_builder.h"

namespace flexarm::pictures {
namespace {

using scene::JointKind;

constexpr double kUpper = 0.7, kLower = 0.5, kHeight = 0.4, kShoulder = 0.1, kStroke = 0.3;  ///< [m]

/// Returns a column that turns, with two links that turn about horizontal axes and a slide at the end.
scene::SceneBuilder column_arm() {
  scene::SceneBuilder b("column");
  for (const char* link : {"column", "upper", "lower", "slider"})
    b.body(link, 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
  b.joint("turn", JointKind::Revolute, "world", "column").axis = Vector3::UnitZ();
  const auto add = [&](const char* name, JointKind kind, const char* parent, const char* child, const Vector3& origin,
                       const Vector3& axis) {
    scene::JointDescription& joint = b.joint(name, kind, parent, child);
    joint.origin.position = origin;
    joint.axis = axis;
    if (kind == JointKind::Prismatic) joint.limits = scene::JointLimits{0, kStroke, 0, {}};
  };
  add("shoulder", JointKind::Revolute, "column", "upper", {kShoulder, 0, kHeight}, Vector3::UnitY());
  add("elbow", JointKind::Revolute, "upper", "lower", {kUpper, 0, 0}, Vector3::UnitY());
  add("slide", JointKind::Prismatic, "lower", "slider", {kLower, 0, 0}, Vector3::UnitX());
  return b;
}

TEST(SceneExtent, HoldsAllThatAnArmReaches) {
  Simulation simulation(column_arm().scene);
  const SceneExtent extent = scene_extent(simulation);
  // The shoulder moves around the axis of the column, at the upper end of the column. Parts on the ground count as
  // well.
  const double reach = kShoulder + kUpper + kLower + kStroke;
  EXPECT_GE(extent.radius, reach);
  EXPECT_LE(extent.radius, reach + kHeight / 2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), stroke(0, kStroke);
  double farthest = 0;
  for (int n = 0; n < 500; ++n) {
    const bool is_stretched = n % 5 == 0;
    simulation.set_joint_state({{0, angle(random), {}},
                                {1, angle(random), {}},
                                {2, is_stretched ? 0 : angle(random), {}},
                                {3, is_stretched ? kStroke : stroke(random), {}}});
    for (std::size_t link = 0; link < simulation.link_names().size(); ++link)
      farthest = std::max(farthest, (simulation.link_pose(link).position - extent.center).norm());
  }
  EXPECT_LE(farthest, extent.radius * (1 + 1e-12));
  EXPECT_GT(farthest, 0.85 * extent.radius);
}

TEST(SceneExtent, IsOfThePresentPlacesOfWhatNoJointMoves) {
  scene::SceneBuilder b("rod");
  b.beam("rod", {{2, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 200, 250, 300, 0.5, 0.02, 0.01, 0.01}, 2, 2);
  b.joint("clamp", JointKind::Fixed, "world", "rod");
  const SceneExtent extent = scene_extent(Simulation(b.scene));
  EXPECT_NEAR(extent.radius, 1, 1e-12);
  EXPECT_NEAR((extent.center - Vector3(1, 0, 0)).norm(), 0, 1e-12);
}

// Walls do not make an arm small in the picture, but its pedestal belongs to it.
TEST(SceneExtent, HasOfWhatIsFixedOnlyWhatIsNear) {
  const SceneExtent alone = scene_extent(Simulation(column_arm().scene));
  const auto with_fixed = [](const Vector3& place) {
    scene::SceneBuilder b = column_arm();
    b.body("fixed", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
    b.joint("weld", JointKind::Fixed, "world", "fixed").origin.position = place;
    return scene_extent(Simulation(b.scene));
  };
  const SceneExtent far = with_fixed({50, 0, 0}), near = with_fixed({0, 0, -2});
  EXPECT_EQ(far.radius, alone.radius);
  EXPECT_EQ(far.center, alone.center);
  EXPECT_GE((near.center - Vector3(0, 0, -2)).norm(), near.radius * (1 - 1e-12));
  EXPECT_LE((near.center - Vector3(0, 0, -2)).norm(), near.radius * (1 + 1e-12));
}

TEST(SceneExtent, IsOfAllIfNothingCanMove) {
  scene::SceneBuilder b("still");
  for (const char* name : {"left", "right"}) {
    b.body(name, 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
    b.joint(std::string("weld_") + name, JointKind::Fixed, "world", name).origin.position =
        Vector3(name[0] == 'l' ? -3 : 5, 0, 0);
  }
  const SceneExtent extent = scene_extent(Simulation(b.scene));
  EXPECT_NEAR(extent.radius, 4, 1e-12);
  EXPECT_LT((extent.center - Vector3(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((extent.half - Vector3(4, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace flexarm::pictures
