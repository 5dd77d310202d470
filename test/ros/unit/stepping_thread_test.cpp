// Tests the thread that makes the steps of the node: pace, commands, halts and failures.
#include "stepping/stepping_thread.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "flexarm/simulation/payloads.h"
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

// ---------------------------------------------------------------- links come and go

/// Rotors of 0.1 kg m^2 on hinges with these names and servos in mode effort, without gravity. Each link is called
/// "of_" and the name of its hinge.
Simulation rotors(const std::vector<std::string>& hinges, ServoMode mode = ServoMode::Effort) {
  test::SceneBuilder b;
  b.scene.gravity.setZero();
  for (const std::string& hinge : hinges) {
    b.body("of_" + hinge, 1, {0, 0, 0}, 0.1 * Matrix3::Identity());
    b.joint(hinge, scene::JointKind::Continuous, "world", "of_" + hinge, {0, 0, 0}, {0, 0, 1});
    scene::ServoDescription servo;
    servo.coordinate = hinge;
    servo.mode = mode;
    servo.kp = mode == ServoMode::Position ? 100 : 0;
    b.scene.servos.push_back(servo);
  }
  b.scene.integrator.step = 0.001;
  return Simulation(b.scene);
}

/// Removes the link of a hinge while the thread is halted, as the node does.
void take_away(SteppingThread& thread, const std::string& hinge) {
  Simulation edited = thread.simulation().copy();
  remove(edited, "of_" + hinge);
  const Renumbering places(thread.simulation(), edited);
  thread.go_on_with_scene(std::move(edited), places);
}

double effort_of(SteppingThread& thread, const std::string& hinge) {
  return thread.simulation().effort(*thread.simulation().find_coordinate(hinge));
}

// In lock step, commands wait for their steps. Each message still causes its step if what it commands is gone.
TEST(SteppingThread, WaitingCommandsOfCoordinatesThatAreGoneAreDropped) {
  for (const bool last_goes : {true, false}) {
    Pace pace;
    pace.lock_step = true;
    SteppingThread thread(rotors({"a", "b", "c"}), pace, [] {});
    const std::string gone = last_goes ? "c" : "a";
    const std::size_t went = last_goes ? 2 : 0;
    ASSERT_TRUE(thread.command({{Commanded::SetPoint, went, 5}}));
    ASSERT_TRUE(
        thread.command({{Commanded::SetPoint, went, 6}, {Commanded::SetPoint, 1, 2}, {Commanded::Effort, went, 7}}));
    ASSERT_TRUE(thread.command({{Commanded::SetPoint, 1, 3}}));
    take_away(thread, gone);
    thread.run(true);
    std::uint64_t steps = 0;
    for (int n = 0; n < 3; ++n) {
      for (int waited = 0; thread.reports().empty() && waited < 10000; ++waited)
        std::this_thread::sleep_for(milliseconds(1));
      ASSERT_FALSE(thread.reports().empty()) << gone;
      steps = thread.reports().front().steps;
      thread.reports().pop();
    }
    thread.halt();
    EXPECT_EQ(steps, 3);
    EXPECT_EQ(effort_of(thread, "b"), 3) << gone;
    EXPECT_EQ(effort_of(thread, last_goes ? "a" : "c"), 0) << gone;
  }
}

TEST(SteppingThread, CommandsTrajectoriesAndGripsFollowTheirCoordinates) {
  scene::SceneDescription scene = rotors({"a", "b", "c", "d"}, ServoMode::Position).scene();
  scene.servos.pop_back();
  SteppingThread thread(Simulation(scene), {}, [] {});
  const double end = 0.1;
  thread.trajectories().follow({{0, 1}, 0, {{end, {1, 2}, {}, {}}}}, 0, {0, 0});
  thread.grips().close(2, 0.5, 0);
  ASSERT_TRUE(thread.command({{Commanded::Effort, 3, 4, 0.01}}));
  ASSERT_TRUE(thread.advance());
  take_away(thread, "a");
  EXPECT_EQ(effort_of(thread, "d"), 4);
  for (int n = 2; n <= 50; ++n) {
    ASSERT_TRUE(thread.advance());
    EXPECT_NEAR(thread.simulation().set_point(0), 2 * n * 0.001 / end, 1e-12);
  }
  EXPECT_EQ(thread.simulation().set_point(1), 0.5);
  take_away(thread, "b");
  take_away(thread, "c");
  ASSERT_TRUE(thread.advance());
  EXPECT_EQ(effort_of(thread, "d"), 0) << "its time is over";
}

// The wrench of a link that is now fixed to the world ends. The others go on.
TEST(SteppingThread, WrenchesFollowTheirLinksUntilTheseAreGoneOrFixed) {
  test::SceneBuilder b;
  b.scene.gravity.setZero();
  for (const char* name : {"first", "held", "last"}) {
    b.body(name, 2, {0, 0, 0}, 0.1 * Matrix3::Identity());
    b.joint(std::string("of_") + name, scene::JointKind::Floating, "world", name, {0, 0, 0}, {0, 0, 1});
  }
  b.scene.integrator.step = 0.001;
  SteppingThread thread(Simulation(b.scene), {}, [] {});
  for (const char* name : {"first", "held", "last"}) {
    const std::vector<std::string>& links = thread.simulation().link_names();
    const auto link = static_cast<std::size_t>(std::find(links.begin(), links.end(), name) - links.begin());
    thread.wrenches().add({link, {0, 0, 0}, {{6, 0, 0}, {0, 0, 0}}, false}, 0, Command::kForEver);
  }
  const auto go_on_with = [&](const auto& edit) {
    Simulation edited = thread.simulation().copy();
    edit(edited);
    const Renumbering places(thread.simulation(), edited);
    thread.go_on_with_scene(std::move(edited), places);
  };
  go_on_with([](Simulation& simulation) { attach(simulation, "held", "world"); });
  go_on_with([](Simulation& simulation) { remove(simulation, "first"); });
  thread.wrenches().add({thread.simulation().link_names().size() - 1, {0, 0, 0}, {{0, 6, 0}, {0, 0, 0}}, false}, 0,
                        Command::kForEver);
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(thread.advance());
  const Simulation& simulation = thread.simulation();
  // Three coordinates of translation and three of rotation; 6 N on 2 kg from rest for 0.1 s.
  EXPECT_NEAR(simulation.velocity(*simulation.find_coordinate("of_last/x")), 0.3, 1e-9);
  EXPECT_NEAR(simulation.velocity(*simulation.find_coordinate("of_last/y")), 0.3, 1e-9);
  go_on_with([](Simulation& simulation) { detach(simulation, "held"); });
  ASSERT_TRUE(thread.advance());
  EXPECT_NEAR(simulation.velocity(*simulation.find_coordinate("of_held/x")), 0, 1e-9) << "it does not come back";
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
