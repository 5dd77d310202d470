// Tests BackgroundWriter, which writes results from copies of the state in another thread: it must write the same as a
// writer in the thread that steps.
#include "simulation/background_writer.h"

#include <chrono>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <thread>

#include "simulation/everything_scene.h"
#include "simulation/inside.h"
#include "support/refusal.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

using Rows = std::vector<std::vector<double>>;

/// A writer that keeps all columns of each row, and the sample of a sensor after each step.
class Recorder : public ResultWriter {
 public:
  Recorder(const Simulation& simulation, Rows& rows)
      : columns_(simulation, ResultColumns::Solver::With, {"*"}), rows_(rows) {}
  void write_row(const Simulation& simulation) override { rows_.push_back(columns_.row(simulation, take_counts())); }
  void note_step(const Simulation& simulation, const StepResult& result) override {
    ResultWriter::note_step(simulation, result);
    rows_.push_back({simulation.time()});
    for (std::size_t i = 0; i < simulation.scene().sensors.size(); ++i)
      for (const double value : simulation.sample(i).values) rows_.back().push_back(value);
  }
  bool looks_at_steps() const override { return true; }
  void close() override { rows_.push_back({}); }

 private:
  ResultColumns columns_;
  Rows& rows_;
};

/// Returns the rows that are written every third step of `steps`. On the way the simulation is reset once, and its
/// steps become shorter.
Rows recorded(const scene::SceneDescription& scene, int steps, bool in_background) {
  Rows rows;
  Simulation simulation(scene);
  const auto make = [&](const Simulation& shown) { return std::make_unique<Recorder>(shown, rows); };
  std::unique_ptr<ResultWriter> writer = make(simulation);
  if (in_background) writer = std::make_unique<BackgroundWriter>(simulation, make);
  writer->write_row(simulation);
  for (int n = 0; n < steps; ++n) {
    if (n == steps / 2) simulation.set_step_size(0.5 * simulation.step_size());
    if (n == 2 * steps / 3) simulation.reset();
    writer->note_step(simulation, simulation.step());
    if (n % 3 == 0) writer->write_row(simulation);
  }
  writer->close();
  return rows;
}

void expect_same_rows(const scene::SceneDescription& scene, int steps) {
  const Rows here = recorded(scene, steps, false), there = recorded(scene, steps, true);
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    ASSERT_EQ(here[i].size(), there[i].size()) << "row " << i;
    if (here[i].empty()) continue;  // an empty vector has no address to compare
    EXPECT_EQ(std::memcmp(here[i].data(), there[i].data(), here[i].size() * sizeof(double)), 0) << "row " << i;
  }
}

TEST(BackgroundWriter, WritesTheSameBits) {
  for (const char* path : {"config/demo_arm.urdf", "config/examples/joints.urdf", "config/examples/six_axis_arm.urdf",
                           "config/examples/sliding_arm.urdf", "config/speed/flying_spaghetti.urdf"}) {
    SCOPED_TRACE(path);
    expect_same_rows(scene_at(path), 300);
  }
}

TEST(BackgroundWriter, WritesTheSameBitsOfAnExplicitScheme) {
  scene::SceneDescription scene = scene_at("config/examples/rigid_double_pendulum.urdf");
  scene.integrator.scheme = "rk4";
  expect_same_rows(scene, 30);
}

TEST(BackgroundWriter, WritesWhatSensorsWithNoiseMeasured) {
  SceneBuilder builder = everything_scene();
  for (const auto& [kind, link] : {std::pair(scene::SensorKind::Wrench, "spherical_body"),
                                   {scene::SensorKind::Strain, "beam3"},
                                   {scene::SensorKind::Imu, "beam4"}}) {
    builder.sensor(std::string("on_") + link, kind, link, {0.05, 0.01, 0});
    builder.scene.sensors.back().noise = {0.01};
    builder.scene.sensors.back().rate = 300;
  }
  expect_same_rows(builder.scene, 300);
}

// The model changes when the bead leaves its line. The bead then floats, so that its origin moves along with it.
TEST(BackgroundWriter, WritesTheSameBitsWhereSomethingLeavesItsLine) {
  SceneBuilder b;
  b.beam("line", {{2, 0, 0}}, section(2e3, 1e3, 80, 100, 1, 0.2, 0.1), 4, 2);
  b.body("bead", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
  b.joint("free", scene::JointKind::Floating, "world", "line");
  b.joint("run", scene::JointKind::Slide, "line", "bead").slide = scene::SlideDescription{1.5, scene::JointKind::Fixed};
  b.scene.joints.back().slide->on_end = scene::SlideDescription::End::Free;
  b.scene.initial_joints.push_back({"run", 1.5, 5.0, {}});
  b.scene.integrator.step = 0.005;
  Simulation simulation(b.scene);
  for (int n = 0; n < 60; ++n) ASSERT_TRUE(simulation.step().converged);
  ASSERT_FALSE(state_of(simulation).left_lines.empty());
  expect_same_rows(b.scene, 120);
}

/// A writer that notes the times of rows, and calls `before_row` before each of them.
class Noting : public ResultWriter {
 public:
  Noting(std::vector<double>& times, std::function<void()> before_row)
      : times_(times), before_row_(std::move(before_row)) {}
  void write_row(const Simulation& simulation) override {
    before_row_();
    times_.push_back(simulation.time());
  }
  void close() override {}

 private:
  std::vector<double>& times_;
  std::function<void()> before_row_;
};

Simulation pendulum() {
  return Simulation(scene_at("config/examples/rigid_double_pendulum.urdf"));
}

TEST(BackgroundWriter, LosesNoRowOfASlowWriter) {
  Simulation simulation = pendulum();
  std::vector<double> written, made;
  BackgroundWriter writer(simulation, [&](const Simulation&) {
    return std::make_unique<Noting>(written, [] { std::this_thread::sleep_for(std::chrono::microseconds(50)); });
  });
  for (int n = 0; n < 1000; ++n) {
    simulation.step();
    made.push_back(simulation.time());
    writer.write_row(simulation);
  }
  writer.close();
  EXPECT_EQ(written, made);
}

TEST(BackgroundWriter, WritesAllRowsWhereTheRunEndsByAnError) {
  Simulation simulation = pendulum();
  std::vector<double> written;
  {
    BackgroundWriter writer(simulation, [&](const Simulation&) { return std::make_unique<Noting>(written, [] {}); });
    for (int n = 0; n < 10; ++n) writer.write_row(simulation);
  }
  EXPECT_EQ(written.size(), 10u);
}

TEST(BackgroundWriter, TellsTheWritersError) {
  Simulation simulation = pendulum();
  std::vector<double> written;
  BackgroundWriter writer(simulation, [&](const Simulation&) {
    return std::make_unique<Noting>(written, [&] {
      if (written.size() == 5) throw std::runtime_error("disk full");
    });
  });
  const auto write_on = [&] {
    for (int n = 0; n < 10000; ++n) writer.write_row(simulation);
  };
  EXPECT_EQ(refusal<std::runtime_error>(write_on), "disk full");
  EXPECT_EQ(written.size(), 5u);
  EXPECT_THROW(writer.close(), std::runtime_error);
}

TEST(Snapshot, OfNothingIsRefused) {
  Simulation simulation = pendulum();
  EXPECT_THROW(simulation.restore(Snapshot()), std::invalid_argument);
}

TEST(Snapshot, IsNotChangedByWhatIsTakenIntoItsCopy) {
  Simulation simulation = pendulum();
  const Snapshot start = simulation.snapshot();
  Snapshot later = start;
  simulation.step();
  simulation.snapshot(later);
  simulation.restore(start);
  EXPECT_EQ(simulation.time(), 0);
  simulation.restore(later);
  EXPECT_EQ(simulation.time(), simulation.step_size());
}

TEST(Copy, GoesItsOwnWay) {
  Simulation simulation = pendulum();
  simulation.step();
  Simulation copy = simulation.copy();
  const double before = copy.position(0);
  simulation.step();
  EXPECT_EQ(copy.position(0), before);
  copy.step();
  EXPECT_EQ(copy.time(), simulation.time());
  copy.reset();
  EXPECT_EQ(copy.time(), 0);
}

TEST(SpscRing, HasAnEntryAtLeast) {
  EXPECT_THROW(SpscRing<int>(0), std::invalid_argument);
  SpscRing<int> ring(1);
  EXPECT_TRUE(ring.has_room());
  EXPECT_FALSE(ring.has_room(2));
}

}  // namespace
}  // namespace flexarm::test
