// What scripts/run shows: config/demo_arm.urdf, driven by the schedule of config/demo_commands.yaml.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

/// A constant effort on one joint.
struct Pulse {
  std::string joint;
  double begin, end;  ///< [s]
  double effort;      ///< [N m]
};
struct Schedule {
  double period = 0;  ///< [s]
  std::vector<Pulse> pulses;
};

/// `key: value` of a line, without the brackets of a list; empty where there is none.
std::string value_of(const std::string& line, const std::string& key) {
  std::smatch match;
  const std::regex pattern("\\b" + key + ": *(?:\\[([^\\]]*)\\]|([^,}\\s]+))");
  return std::regex_search(line, match, pattern) ? match[1].str() + match[2].str() : "";
}

double number_of(const std::string& line, const std::string& key, double otherwise) {
  const std::string text = value_of(line, key);
  return text.empty() ? otherwise : std::stod(text);
}

/// A command of the schedule, with its repetitions, for each of its joints.
void append_pulses(const std::string& line, std::vector<Pulse>& pulses) {
  std::istringstream names(std::regex_replace(value_of(line, "names"), std::regex(","), " "));
  std::istringstream efforts(std::regex_replace(value_of(line, "efforts"), std::regex(","), " "));
  std::string name;
  double effort;
  while (names >> name && efforts >> effort) {
    for (int k = 0; k < number_of(line, "repeat", 1); ++k) {
      const double begin = std::stod(value_of(line, "time")) + k * number_of(line, "every", 0);
      pulses.push_back({name, begin, begin + std::stod(value_of(line, "duration")), effort});
    }
  }
}

/// Reads as much YAML as the file uses: the period, and one command on each line that begins with `-`.
Schedule read_schedule() {
  Schedule schedule;
  std::ifstream file(source_path("config/demo_commands.yaml"));
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("period:", 0) == 0) schedule.period = std::stod(value_of(line, "period"));
    if (line.find_first_not_of(' ') == line.find("- {")) append_pulses(line, schedule.pulses);
  }
  return schedule;
}

/// Distance of a boom's end from the straight line along the axis of its root [m].
double deflection(const Simulation& simulation, std::size_t boom) {
  const Pose root = simulation.link_pose(boom);
  const Vector3 end = root.orientation.conjugate() * (simulation.tip_pose(boom).position - root.position);
  return end.tail<2>().norm();
}

class Demo : public ::testing::Test {
 protected:
  Demo() : scene_(scene::read_scene_file(source_path("config/demo_arm.urdf"))), schedule_(read_schedule()) {}

  /// The schedule's efforts for the next step. Every pulse begins and ends with a step: the middle of a step tells.
  void command(Simulation& simulation) const {
    const double middle = simulation.time() + simulation.step_size() / 2;
    for (const Pulse& pulse : schedule_.pulses) simulation.command_effort(coordinate(simulation, pulse), 0);
    for (const Pulse& pulse : schedule_.pulses)
      if (pulse.begin < middle && middle < pulse.end)
        simulation.command_effort(coordinate(simulation, pulse), pulse.effort);
  }
  static std::size_t coordinate(const Simulation& simulation, const Pulse& pulse) {
    return simulation.find_coordinate(pulse.joint).value();
  }

  scene::ReadResult scene_;
  Schedule schedule_;
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

TEST_F(Demo, ScheduleIsUnderstood) {
  EXPECT_EQ(schedule_.period, 26);
  ASSERT_EQ(schedule_.pulses.size(), 2 * (1 + 8 + 7 + 1 + 1 + 1u));
  const Pulse& last = schedule_.pulses.back();
  EXPECT_EQ(last.joint, "elbow_pitch");
  EXPECT_EQ(last.begin, 14);
  EXPECT_EQ(last.end, 16);
  EXPECT_EQ(last.effort, -180);
}

TEST_F(Demo, BoomsSwingByDecimetresAndTheEnergyAccountBalances) {
  ASSERT_TRUE(scene_.scene);
  Simulation simulation(*scene_.scene);
  for (const Pulse& pulse : schedule_.pulses) ASSERT_TRUE(simulation.find_coordinate(pulse.joint)) << pulse.joint;
  const std::size_t upper = 2, lower = 4;
  ASSERT_EQ(simulation.link_names().at(upper), "upper_arm");
  ASSERT_EQ(simulation.link_names().at(lower), "lower_arm");

  double upper_swing = 0, lower_swing = 0, imbalance = 0;
  while (simulation.time() < schedule_.period) {
    command(simulation);
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << "at " << simulation.time() << " s: " << to_string(result.reason);
    ASSERT_EQ(result.halvings, 0) << "at " << simulation.time() << " s";
    upper_swing = std::max(upper_swing, deflection(simulation, upper));
    lower_swing = std::max(lower_swing, deflection(simulation, lower));
    const Energies energies = simulation.energies();  // at rest in the beginning: the account starts with zero
    imbalance = std::max(imbalance, std::abs(energies.total() - energies.work + energies.dissipated));
  }
  EXPECT_GT(upper_swing, 0.1);
  EXPECT_GT(lower_swing, 0.1);
  EXPECT_LT(imbalance, 1e-6 * simulation.energies().work) << "only what Newton leaves unsolved may leak";
}

}  // namespace
}  // namespace flexarm::test
