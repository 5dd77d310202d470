// Tests that every example scene moves: its steps converge, and its energies add up.
#include <filesystem>

#include "flexarm/scene/urdf_reader.h"
#include "support/runs.h"
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
    const double start = energy_account(simulation);
    double largest = std::abs(start);
    run(simulation, 50, [&] {
      const Energies now = simulation.energies();
      largest = std::max({largest, now.kinetic, std::abs(now.potential), now.strain, std::abs(now.work)});
      EXPECT_NEAR(energy_account(simulation), start, 1e-7 * largest) << simulation.time();
    });
  }
}

}  // namespace
}  // namespace flexarm::test
