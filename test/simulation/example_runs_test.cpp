// Tests that every example scene moves: its steps converge, and its energies add up.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

TEST(ExampleScenes, Move) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(source_path("config/examples")))
    if (entry.path().extension() == ".urdf") paths.push_back(entry.path());
  ASSERT_GE(paths.size(), 20u);
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    const scene::ReadResult read = scene::read_scene_file(path);
    ASSERT_TRUE(read.scene);
    Simulation simulation(*read.scene);
    const double start = simulation.energies().total();
    double largest = std::abs(start);
    for (int i = 0; i < 50; ++i) {
      ASSERT_TRUE(simulation.step().converged) << simulation.time();
      const Energies now = simulation.energies();
      largest = std::max({largest, now.kinetic, std::abs(now.potential), now.strain, std::abs(now.work)});
      EXPECT_NEAR(now.total() + now.dissipated - now.work, start, 1e-7 * largest) << simulation.time();
    }
  }
}

}  // namespace
}  // namespace flexarm::test
