// Tests <clearance>: how joints with play are read, and the errors of those that close loops.
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

const std::string kPlay = text_of_file(test::source_path("test/fuzz/seeds/play.urdf"));

std::string play_with(const std::string& from, const std::string& to) {
  std::string text = kPlay;
  return text.replace(text.find(from), from.size(), to);
}

TEST(Clearances, OfTheTreeAreFloatingJoints) {
  const ReadResult result = read(kPlay);
  ASSERT_TRUE(result.scene);
  const SceneDescription& scene = *result.scene;
  ASSERT_EQ(scene.clearances.size(), 3u);
  ASSERT_EQ(scene.joints.size(), 2u);
  for (const JointDescription& joint : scene.joints) EXPECT_EQ(joint.kind, JointKind::Floating) << joint.name;
  const ClearanceDescription& pin = scene.clearances[0];
  EXPECT_EQ(pin.joint.kind, JointKind::Continuous);
  EXPECT_EQ(pin.joint.axis, Vector3::UnitY());
  EXPECT_FALSE(pin.closes_loop);
  EXPECT_EQ(pin.radius, 1e-3);
  EXPECT_EQ(pin.length, 0.1);
  EXPECT_EQ(pin.journal, 0.02);
  EXPECT_EQ(pin.stiffness, 1e6);
  EXPECT_EQ(pin.restitution.values, std::vector<double>{0.5});
  EXPECT_EQ(pin.friction, 0.1);
  EXPECT_EQ(pin.location.line, 5);
  const ClearanceDescription& ball = scene.clearances[1];
  EXPECT_EQ(ball.joint.kind, JointKind::Spherical);
  EXPECT_FALSE(ball.length || ball.width || ball.stiffness);
  EXPECT_EQ(ball.restitution.values, std::vector<double>{0.3});
}

TEST(Clearances, OfLoopsAddNoJoint) {
  const ReadResult result = read(kPlay);
  ASSERT_TRUE(result.scene);
  EXPECT_TRUE(result.scene->loop_joints.empty());
  const ClearanceDescription& guide = result.scene->clearances[2];
  EXPECT_TRUE(guide.closes_loop);
  EXPECT_EQ(guide.joint.kind, JointKind::Prismatic);
  EXPECT_EQ(guide.joint.child_origin.position, Vector3::UnitX());
  EXPECT_EQ(guide.width, 0.05);
}

TEST(Clearances, OfLoopsHaveNamesAndLinks) {
  const auto errors = [](const std::string& text) {
    std::string found;
    for (const Diagnostic& finding : read(text).diagnostics)
      if (finding.text().find("urdfdom") == std::string::npos) found += finding.text();
    return found;
  };
  EXPECT_EQ(errors(kPlay), "");
  EXPECT_EQ(errors(play_with("loop_joint name=\"guide\"", "loop_joint name=\"ball\"")),
            "scene.urdf:14: <loop_joint> 'ball': name is taken, by line 10, got 'ball'");
  EXPECT_EQ(errors(play_with("<parent link=\"world\"/> <child link=\"beam\"/> <origin",
                             "<parent link=\"word\"/> <child "
                             "link=\"beam\"/> <origin")),
            "scene.urdf:14: <loop_joint> 'guide': parent must be a link of the scene (world, rod, beam), got 'word'");
}

}  // namespace
}  // namespace flexarm::scene
