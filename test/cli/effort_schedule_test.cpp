/// Tests schedules of efforts (JSON): what is read, what is refused, and the impulse that a schedule gives to a joint.
#include "cli/effort_schedule.h"

#include <gtest/gtest.h>

#include <fstream>

#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm::cli {
namespace {

TEST(EffortSchedule, OfTheDemoIsRead) {
  const EffortSchedule schedule = read_effort_schedule(test::source_path("config/demo_commands.yaml"));
  EXPECT_EQ(schedule.period, 26);
  const std::vector<EffortPulse>& pulses = schedule.pulses;
  ASSERT_EQ(pulses.size(), 2u * (1 + 9 + 8 + 1 + 1 + 1));
  EXPECT_EQ(pulses[0].joint, "shoulder_yaw");
  EXPECT_EQ(pulses[0].effort, 1000);
  EXPECT_EQ(pulses.back().joint, "elbow_pitch");
  EXPECT_EQ(pulses.back().begin, 17);
  EXPECT_EQ(pulses.back().end, 20);
  EXPECT_EQ(pulses.back().effort, -200);
}

TEST(EffortSchedule, SaysWhatItDoesNotUnderstand) {
  const std::string path = testing::TempDir() + "flexarm_effort_schedule.yaml";
  const auto error_of = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_effort_schedule(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string head = "# two\ncommands:\n";
  EXPECT_EQ(error_of(head + "- {time: 1, names: [a, b], efforts: [1, -2.5], duration: 0.5}\n"), "");
  EXPECT_EQ(error_of(head + "- time: 1\n  names: [a]\n  efforts: [1]\n  duration: 0.5\n"), "") << "YAML as it comes";
  for (const char* bad :
       {"{time: 1, names: [a, b], efforts: [1], duration: 0.5}", "{time: 1, names: [a], efforts: [one], duration: 0.5}",
        "{time: 1, names: [a], efforts: [1], duration: 0.5, repeat: often}",
        "{names: [a], efforts: [1], duration: 0.5}", "{time: 1, names: [a], efforts: [1]}", "word"}) {
    const std::string error = error_of(head + "- " + bad + "\n");
    EXPECT_NE(error.find(path + ":3: expected {time: s, "), std::string::npos) << bad << ": " << error;
    EXPECT_NE(error.find("got '" + std::string(bad) + "'"), std::string::npos) << error;
  }
  EXPECT_NE(error_of("period: 3\n").find("at least one command"), std::string::npos);
  EXPECT_NE(error_of("period: long\n").find(path + ":1: "), std::string::npos);
  EXPECT_NE(error_of("a: 1\ncommands: [\n").find(path + ":"), std::string::npos) << "no YAML";
  EXPECT_THROW(read_effort_schedule(path + "/missing"), std::runtime_error);
}

TEST(EffortPlayer, KeepsTheImpulseWhateverTheStep) {
  scene::SceneDescription scene = *scene::read_scene_file(test::source_path("config/demo_arm.urdf")).scene;
  const std::vector<EffortPulse> pulses = {{"wrist_roll", 0.1, 0.25, 2}, {"wrist_roll", 0.25, 0.3, -1}};
  for (const double step : {0.01, 0.05, 0.07, 0.4}) {
    scene.integrator.step = step;
    Simulation simulation(scene);
    const EffortPlayer player(pulses, simulation);
    const std::size_t roll = simulation.find_coordinate("wrist_roll").value();
    double impulse = 0;
    while (simulation.time() < 0.4) {
      player.command(simulation);
      ASSERT_TRUE(simulation.step().converged);
      // `effort` is the effort of the motor alone, without the joint's damper.
      impulse += simulation.effort(roll) * step;
    }
    EXPECT_NEAR(impulse, 2 * 0.15 - 0.05, 1e-12) << step;
  }
  EXPECT_THROW(EffortPlayer({{"knee", 0, 1, 1}}, Simulation(scene)), std::runtime_error);
}

}  // namespace
}  // namespace flexarm::cli
