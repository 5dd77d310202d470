// Tests simulations in several threads. The program is built with the thread sanitizer, which ends it with an error if
// threads have a data race.
#include <array>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/batch.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

/// Returns the positions of a scene's coordinates after some steps.
std::vector<double> positions_after_steps(const scene::SceneDescription& scene) {
  Simulation simulation(scene);
  for (int n = 0; n < 3; ++n) EXPECT_TRUE(simulation.step().converged);
  std::vector<double> positions;
  for (std::size_t c = 0; c < simulation.coordinate_names().size(); ++c) positions.push_back(simulation.position(c));
  return positions;
}

// Simulations are built and run at the same time, from one description. The scenes have beams in packs, a closed loop,
// a slider and joints of each kind.
TEST(Simulations, RunEachInAThreadOfItsOwn) {
  for (const char* name : {"flexible_two_link_arm", "four_bar", "sliding_arm", "joints"}) {
    const scene::ReadResult read =
        scene::read_scene_file(test::source_path("config/examples/" + std::string(name) + ".urdf"));
    ASSERT_TRUE(read.scene) << name;
    std::array<std::vector<double>, 3> positions;
    std::array<std::thread, 3> threads;
    for (std::size_t i = 0; i < threads.size(); ++i)
      threads[i] = std::thread([&, i] { positions[i] = positions_after_steps(*read.scene); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_FALSE(positions[0].empty()) << name;
    EXPECT_EQ(positions[0], positions[1]) << name;
    EXPECT_EQ(positions[0], positions[2]) << name;
  }
}

// A batch hands its simulations to its threads again and again.
TEST(Simulations, AreSteppedTogetherInABatch) {
  const scene::ReadResult read =
      scene::read_scene_file(test::source_path("config/examples/flexible_two_link_arm.urdf"));
  ASSERT_TRUE(read.scene);
  Batch batch(Simulation(*read.scene), 7, 3);
  std::vector<StepResult> results;
  for (int n = 0; n < 10; ++n) {
    batch.step(results);
    for (const StepResult& result : results) EXPECT_TRUE(result.converged);
  }
  for (std::size_t i = 1; i < batch.size(); ++i) EXPECT_EQ(batch[i].position(0), batch[0].position(0));
}

}  // namespace
}  // namespace flexarm
