// Tests the random arms of the benchmark: they are reproducible, valid, and of all kinds.
#include "bench/random_arms.h"

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {
namespace {

TEST(RandomArms, HaveOneToSevenJointsAndBothKindsOfLinks) {
  int rigid = 0, flexible = 0, automatic = 0;
  for (int i = 0; i < kRandomArms; ++i) {
    const std::string text = random_arm(i);
    EXPECT_EQ(text, random_arm(i));
    const scene::ReadResult read = scene::read_scene_text(text, "arm");
    ASSERT_TRUE(read.scene) << scene::to_text(read.diagnostics);
    EXPECT_TRUE(read.diagnostics.empty()) << scene::to_text(read.diagnostics);
    EXPECT_EQ(static_cast<int>(read.scene->joints.size()), random_arm_joints(i));
    EXPECT_GE(random_arm_joints(i), 1);
    EXPECT_LE(random_arm_joints(i), 7);
    for (std::size_t link = 1; link < read.scene->links.size(); ++link) {
      const auto& beam = read.scene->links[link].beam;
      (beam ? flexible : rigid) += 1;
      automatic += beam && !beam->elements;
    }
    Simulation simulation(*read.scene);
    EXPECT_TRUE(simulation.step().converged) << i;
  }
  EXPECT_GT(rigid, 10);
  EXPECT_GT(flexible, 10);
  EXPECT_GT(automatic, 5);
  EXPECT_LT(automatic, flexible);
}

}  // namespace
}  // namespace flexarm::bench
