// Tests the times of a simulation: round-off of the steps does not add up.
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/csv_writer.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

Simulation falling_bar(const std::string& scheme, double step = 0.001) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("bar", 1, {0.3, 0, 0}, 0.01 * Matrix3::Identity());
  b.joint("hinge", scene::JointKind::Revolute, "world", "bar", {0, 0, 0}, {0, 1, 0});
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = step;
  return Simulation(b.scene);
}

void make_steps(Simulation& simulation, int count) {
  for (int n = 0; n < count; ++n) ASSERT_TRUE(simulation.step().converged);
}

TEST(StepTimes, AreMultiplesOfTheStep) {
  for (const char* scheme : {"em", "em4", "newmark", "hht2", "rk4", "dop853"}) {
    Simulation simulation = falling_bar(scheme);
    for (int n = 1; n <= 1500; ++n) {
      ASSERT_TRUE(simulation.step().converged);
      ASSERT_EQ(simulation.time(), n / 1000.0) << scheme;  // the number nearest to n/1000
    }
  }
}

TEST(StepTimes, DoNotDependOnHalvings) {
  Simulation simulation = falling_bar("em");
  for (int n = 1; n <= 100; ++n) {
    State state = state_of(simulation);
    state.halving_level = n % 4;
    restore(simulation, state);
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_EQ(simulation.time(), n / 1000.0);
  }
}

TEST(StepTimes, GoOnAfterStepsOfOtherLengths) {
  Simulation simulation = falling_bar("em");
  make_steps(simulation, 10);
  const Snapshot before = simulation.snapshot();
  simulation.set_step_size(0.0003);
  make_steps(simulation, 5);
  EXPECT_EQ(simulation.time(), 0.0115);
  simulation.set_step_size(0.001);
  make_steps(simulation, 700);
  EXPECT_EQ(simulation.time(), 0.7115);
  simulation.restore(before);
  make_steps(simulation, 700);
  EXPECT_EQ(simulation.time(), 0.71);
  const double third = 0.001 / 3;
  Simulation other = falling_bar("em", third);
  for (int n = 1; n <= 1000; ++n) {
    ASSERT_TRUE(other.step().converged);
    ASSERT_EQ(other.time(), n * third);
  }
}

TEST(StepTimes, AreTheSameAfterACheckpoint) {
  Simulation first = falling_bar("em"), second = falling_bar("em");
  make_steps(first, 333);
  read_checkpoint_text(second, checkpoint_text(first), "text");
  for (int n = 334; n <= 1000; ++n) {
    ASSERT_TRUE(second.step().converged);
    ASSERT_EQ(second.time(), n / 1000.0);
  }
}

TEST(StepTimes, AreShortInRows) {
  const std::string path = ::testing::TempDir() + "flexarm_step_times_test.csv";
  Simulation simulation = falling_bar("em");
  CsvWriter writer(path, ResultColumns(simulation, ResultColumns::Solver::Without));
  for (int n = 0; n < 12; ++n) {
    make_steps(simulation, 1);
    writer.write_row(simulation);
  }
  writer.close();
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  for (const char* time :
       {"0.001", "0.002", "0.003", "0.004", "0.005", "0.006", "0.007", "0.008", "0.009", "0.01", "0.011", "0.012"}) {
    ASSERT_TRUE(std::getline(in, line));
    EXPECT_EQ(line.substr(0, line.find(',')), time);
  }
  std::remove(path.c_str());
}

}  // namespace
}  // namespace flexarm::test
