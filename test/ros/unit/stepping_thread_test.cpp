// Tests the thread that makes the steps of the node: pace, commands, halts and failures.
#include "stepping/stepping_thread.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace flexarm::node {
namespace {

using std::chrono::milliseconds;

/// A rotor on a hinge with a probe at its rim, which fails if it is driven too fast. `step` in s.
Simulation rotor(double step, int max_halvings = 2, const SimulationOptions& options = {}) {
  test::SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", scene::JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.probe("rim", "rotor", {1, 0, 0});
  b.scene.integrator.step = step;
  b.scene.integrator.max_halvings = max_halvings;
  return Simulation(b.scene, options);
}

std::vector<Command> effort(double value, double lifetime = Command::kForEver) {
  return {{Commanded::Effort, 0, value, lifetime}};
}

/// The reports of successive steps.
class Reports {
 public:
  explicit Reports(SteppingThread& thread) : thread_(thread), shown_(thread.simulation().copy()) {}

  /// Waits for `count` reports and takes them.
  void take(std::size_t count) {
    for (; count > 0; --count) {
      for (int n = 0; thread_.reports().empty() && n < kPatience; ++n) std::this_thread::sleep_for(milliseconds(1));
      ASSERT_FALSE(thread_.reports().empty());
      StepReport& report = thread_.reports().front();
      shown_.restore(report.state);
      steps.push_back(report.steps);
      efforts.push_back(shown_.effort(0));
      positions.push_back(shown_.position(0));
      last = report;
      thread_.reports().pop();
    }
  }
  void take_all() { take(thread_.reports().size()); }

  std::vector<std::uint64_t> steps;
  std::vector<double> efforts, positions;
  StepReport last;

 private:
  static constexpr int kPatience = 10000;  // ms

  SteppingThread& thread_;
  Simulation shown_;
};

bool are_consecutive(const std::vector<std::uint64_t>& steps) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] != i + 1) return false;
  return true;
}

TEST(SteppingThread, EstimatesTheErrorOfItsSteps) {
  Pace pace;
  pace.real_time_factor = 0;
  SteppingThread without(rotor(0.01), pace, [] {});
  EXPECT_FALSE(without.estimates_errors());
  pace.error_window = 0.5;
  SteppingThread thread(rotor(0.01), pace, [] {});
  ASSERT_TRUE(thread.estimates_errors());
  thread.command(effort(0.5));
  thread.take_commands();
  Reports reports(thread);
  for (int n = 0; n < 4; ++n) ASSERT_TRUE(thread.advance());
  reports.take_all();
  EXPECT_GT(reports.last.result.error_estimate, 0);
  thread.between_steps([](Simulation& simulation) { simulation.reset(); });
  ASSERT_TRUE(thread.advance());
  reports.take_all();
  EXPECT_TRUE(std::isnan(reports.last.result.error_estimate)) << "of a single step nothing is known";
}

TEST(SteppingThread, KeepsPaceWithTheClock) {
  SteppingThread thread(rotor(0.001), {}, [] {});
  Reports reports(thread);
  const auto begin = std::chrono::steady_clock::now();
  thread.run(true);
  reports.take(200);
  thread.halt();
  const double wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_TRUE(are_consecutive(reports.steps));
  EXPECT_GE(wall_time, 0.2);
  ASSERT_TRUE(reports.last.due);
  EXPECT_GE(reports.last.lateness, 0);
}

TEST(SteppingThread, TellsWhenEachStepWasDue) {
  using Seconds = std::chrono::duration<double>;
  constexpr double kStep = 0.002;
  SteppingThread thread(rotor(kStep), {}, [] {});
  Reports reports(thread);
  ASSERT_TRUE(thread.advance());
  reports.take(1);
  EXPECT_FALSE(reports.last.due) << "nobody has looked at the clock";
  const auto begin = std::chrono::steady_clock::now();
  thread.run(true);
  reports.take(1);
  const StepReport first = reports.last;
  // The first step is due one step after the beginning. Each other step is due one step after the one before, however
  // late they are.
  ASSERT_TRUE(first.due);
  EXPECT_GE(Seconds(*first.due - begin).count(), kStep - 1e-6);
  reports.take(50);
  thread.halt();
  ASSERT_TRUE(reports.last.due);
  EXPECT_NEAR(Seconds(*reports.last.due - *first.due).count(),
              static_cast<double>(50 + reports.last.overruns - first.overruns) * kStep, 1e-6);
}

TEST(SteppingThread, WaitsForNobodyWhereTheClockDoesNot) {
  SteppingThread thread(rotor(1e-4), {}, [] {});
  thread.run(true);
  std::this_thread::sleep_for(milliseconds(300));  // 3000 steps, while the ring has room for 1024
  thread.halt();
  Reports reports(thread);
  reports.take_all();
  EXPECT_TRUE(are_consecutive(reports.steps));
  EXPECT_TRUE(thread.advance());
  reports.take(1);
  EXPECT_GT(reports.last.steps, reports.steps.size());
}

TEST(SteppingThread, AsFastAsPossibleMissesNothing) {
  int notices = 0;
  Pace pace;
  pace.real_time_factor = 0;
  SteppingThread thread(rotor(0.001), pace, [&] { ++notices; });
  Reports reports(thread);
  thread.run(true);
  for (int n = 0; n < 5; ++n) {
    std::this_thread::sleep_for(milliseconds(5));
    reports.take(1000);
  }
  thread.halt();
  reports.take_all();
  EXPECT_TRUE(are_consecutive(reports.steps));
  EXPECT_EQ(static_cast<std::size_t>(notices), reports.steps.size());
}

TEST(SteppingThread, CommandsActFromTheNextStepForAsLongAsTheyLive) {
  SteppingThread thread(rotor(0.001), {}, [] {});
  Reports reports(thread);
  ASSERT_TRUE(thread.advance());
  ASSERT_TRUE(thread.command(effort(2, 0.003)));
  for (int n = 0; n < 5; ++n) ASSERT_TRUE(thread.advance());
  reports.take(6);
  EXPECT_EQ(reports.efforts, (std::vector<double>{0, 2, 2, 2, 0, 0}));
  EXPECT_TRUE(thread.command(effort(2)));
  thread.forget_commands();
  ASSERT_TRUE(thread.advance());
  reports.take(1);
  EXPECT_EQ(reports.efforts.back(), 0);
}

TEST(SteppingThread, AFloodWhileItIsHaltedLeavesTheLastCommand) {
  SteppingThread thread(rotor(0.001), {}, [] {});
  Reports reports(thread);
  for (int n = 0; n <= 20000; ++n) ASSERT_TRUE(thread.command(effort(n * 1e-4)));
  ASSERT_TRUE(thread.advance());
  reports.take(1);
  EXPECT_EQ(reports.efforts.back(), 2);
}

/// Positions after each of the steps that messages command, with this pause between messages.
std::vector<double> positions_in_lock_step(milliseconds pause) {
  Pace pace;
  pace.lock_step = true;
  SteppingThread thread(rotor(0.001), pace, [] {});
  Reports reports(thread);
  thread.run(true);
  for (int n = 0; n < 50; ++n) {
    thread.command(effort(0.1 * n));
    if (n % 10 == 0) std::this_thread::sleep_for(pause);
  }
  reports.take(50);
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_TRUE(thread.reports().empty()) << "a step that nobody commanded";
  return reports.positions;
}

TEST(SteppingThread, FollowsTrajectoriesUntilAnotherSetPointIsCommanded) {
  scene::SceneDescription scene = rotor(0.001).scene();
  scene::ServoDescription servo;
  servo.coordinate = "shaft";
  servo.kp = 100;
  servo.kd = 20;
  scene.servos.push_back(servo);
  SteppingThread thread(Simulation(scene), {}, [] {});
  thread.trajectories().follow({{0}, 0, {{0.1, {0.5}, {}, {}}}}, 0, {0.0});
  for (int n = 1; n <= 50; ++n) {
    ASSERT_TRUE(thread.advance());
    EXPECT_NEAR(thread.simulation().set_point(0), 5 * n * 0.001, 1e-12);
  }
  EXPECT_GT(thread.simulation().position(0), 0);
  EXPECT_TRUE(thread.trajectories().follows(0));
  EXPECT_TRUE(thread.command({{Commanded::SetPoint, 0, 2}}));
  ASSERT_TRUE(thread.advance());
  EXPECT_EQ(thread.simulation().set_point(0), 2);
  EXPECT_FALSE(thread.trajectories().follows(0));
}

TEST(SteppingThread, LockStepMakesAStepOfEachMessageWhenever) {
  const std::vector<double> at_once = positions_in_lock_step(milliseconds(0));
  EXPECT_EQ(positions_in_lock_step(milliseconds(5)), at_once);
  EXPECT_EQ(std::set<double>(at_once.begin(), at_once.end()).size(), at_once.size()) << "each effort moves it on";
}

TEST(SteppingThread, BetweenStepsTheSimulationIsTheCallers) {
  SteppingThread thread(rotor(0.001), {}, [] {});
  Reports reports(thread);
  thread.run(true);
  for (int n = 0; n < 20; ++n)
    thread.between_steps([&](Simulation& simulation) {
      const double time = simulation.time();
      std::this_thread::sleep_for(milliseconds(1));
      EXPECT_EQ(simulation.time(), time);
    });
  reports.take(20);
  thread.halt();
  reports.take_all();
  EXPECT_TRUE(are_consecutive(reports.steps));
}

TEST(SteppingThread, HaltsWhereAStepFailsAndGoesOn) {
  SteppingThread thread(rotor(0.1), {}, [] {});
  Reports reports(thread);
  thread.command(effort(1e6));
  thread.run(true);
  while (!reports.last.has_failed && !HasFatalFailure()) reports.take(1);
  thread.note_failure();
  EXPECT_FALSE(reports.last.result.converged);
  std::this_thread::sleep_for(milliseconds(250));
  EXPECT_TRUE(thread.reports().empty());
  thread.between_steps([](Simulation& simulation) { simulation.reset(); });
  thread.run(true);
  reports.take(1);
  EXPECT_FALSE(reports.last.has_failed);
}

TEST(SteppingThread, GoesOnWhereAStepIsCutForLackOfTime) {
  SimulationOptions options;
  options.recovery_wall_time = 1e-9;  // has always passed when it is checked
  Pace pace;
  pace.real_time_factor = 0;
  pace.cuts_late_steps = true;
  SteppingThread thread(rotor(0.1, 30, options), pace, [] {});
  Reports reports(thread);
  thread.command(effort(300));  // too fast for a whole step
  thread.run(true);
  int cut = 0;
  for (int n = 0; n < 50; ++n) {
    reports.take(1);
    EXPECT_FALSE(reports.last.has_failed);
    cut += !reports.last.result.converged;
    if (!reports.last.result.converged) {
      EXPECT_EQ(reports.last.result.reason, StepResult::Reason::OutOfTime);
    }
  }
  thread.halt();
  EXPECT_GT(cut, 0);
  EXPECT_NE(reports.positions.back(), reports.positions.front());
}

TEST(SteppingThread, MayBeHaltedWhereAStepFails) {
  for (int n = 0; n < 20; ++n) {
    Pace pace;
    pace.real_time_factor = 0;
    SteppingThread thread(rotor(0.1), pace, [] {});
    thread.command(effort(1e6));
    thread.run(true);
    thread.between_steps([](Simulation&) {});
    thread.halt();
  }
}

}  // namespace
}  // namespace flexarm::node
