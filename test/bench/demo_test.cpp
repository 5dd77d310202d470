// Tests the demo of scripts/run: config/demo_arm.urdf, driven by the schedule of config/demo_commands.yaml.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/effort_schedule.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

/// Distance of a boom's end from the straight axis at its root [m].
double deflection(const Simulation& simulation, std::size_t boom) {
  const Pose root = simulation.link_pose(boom);
  const Vector3 end = root.orientation.conjugate() * (simulation.tip_pose(boom).position - root.position);
  return end.tail<2>().norm();
}

class Demo : public ::testing::Test {
 protected:
  Demo()
      : scene_(scene::read_scene_file(source_path("config/demo_arm.urdf"))),
        schedule_(cli::read_effort_schedule(source_path("config/demo_commands.yaml"))) {}

  scene::ReadResult scene_;
  cli::EffortSchedule schedule_;
};

TEST_F(Demo, SceneIsReadWithoutAnyFinding) {
  EXPECT_TRUE(scene_.scene);
  EXPECT_TRUE(scene_.diagnostics.empty()) << to_text(scene_.diagnostics);
}

TEST_F(Demo, HasTheSixJointsOfTheShuttlesArm) {
  ASSERT_TRUE(scene_.scene);
  EXPECT_EQ(Simulation(*scene_.scene).coordinate_names(),
            (std::vector<std::string>{"shoulder_yaw", "shoulder_pitch", "elbow_pitch", "wrist_pitch", "wrist_yaw",
                                      "wrist_roll"}));
}

TEST_F(Demo, BoomsSwingByADecimetreAndTheEnergyAccountBalances) {
  ASSERT_TRUE(scene_.scene);
  Simulation simulation(*scene_.scene);
  const cli::EffortPlayer player(schedule_.pulses, simulation);
  const std::size_t upper = 2, lower = 4;
  ASSERT_EQ(simulation.link_names().at(upper), "upper_arm");
  ASSERT_EQ(simulation.link_names().at(lower), "lower_arm");

  double upper_swing = 0, lower_swing = 0, imbalance = 0;
  while (simulation.time() < schedule_.period) {
    player.command(simulation);
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << "at " << simulation.time() << " s: " << to_string(result.reason);
    ASSERT_EQ(result.halvings, 0) << "at " << simulation.time() << " s";
    upper_swing = std::max(upper_swing, deflection(simulation, upper));
    lower_swing = std::max(lower_swing, deflection(simulation, lower));
    const Energies energies = simulation.energies();  // at rest at the start, so the account starts with zero
    imbalance = std::max(imbalance, std::abs(energies.total() - energies.work + energies.dissipated));
  }
  EXPECT_GT(upper_swing, 0.04) << "as stiff as the lower one, and loaded less";
  EXPECT_GT(lower_swing, 0.1);
  EXPECT_LT(imbalance, 1e-6 * simulation.energies().work) << "only what Newton leaves unsolved may leak";
}

// Published frequencies of the straight arm with locked motors and without its payload; docs/demo.md names the source.
TEST_F(Demo, HasThePublishedFrequencies) {
  ASSERT_TRUE(scene_.scene);
  scene::SceneDescription scene = *scene_.scene;
  const auto drop = [](auto& things, const std::string& name) {
    things.erase(std::find_if(things.begin(), things.end(), [&](const auto& thing) { return thing.name == name; }));
  };
  drop(scene.joints, "grapple");
  drop(scene.links, "payload");
  drop(scene.probes, "payload");
  for (const scene::DriveDescription& drive : scene.drives)
    scene.springs.push_back({drive.coordinate, *drive.stiffness, 0, {}});
  scene.drives.clear();
  scene.servos.clear();
  scene.initial_joints.clear();
  const std::vector<Mode> modes = Simulation(scene).natural_modes(4);
  const double published[] = {0.3463, 0.4614, 3.5544, 4.2282};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(modes[i].frequency / published[i], 1, 0.05) << i;
}

}  // namespace
}  // namespace flexarm::test
