// Tests that the speed report measures correctly: errors, runs, and the choice of the fastest run.
#include "bench/speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm::bench {
namespace {

const std::string kConfig = test::source_path("config");

SpeedProblem problem_named(const std::string& name) {
  for (const SpeedProblem& problem : speed_problems())
    if (problem.name == name) return problem;
  throw std::invalid_argument(name);
}

TEST(SpeedRuns, ErrorsFallWithTheStepByTheOrderOfTheScheme) {
  // The only problem without sudden loads. Their fast waves would not be resolved by the steps here.
  SpeedProblem problem = problem_named("spin_up");
  problem.until = 4;
  const auto run = [&](const std::string& scheme, double step) {
    return run_speed(kConfig, problem, {scheme, 2, 1, step}).trajectory;
  };
  const Trajectory reference = run("em4", 0.00625);
  for (const auto& [scheme, order] : {std::pair{"em", 2}, {"em0", 2}, {"newmark", 2}, {"em4", 4}}) {
    const double coarse = trajectory_error(run(scheme, 0.2), reference),
                 fine = trajectory_error(run(scheme, 0.1), reference);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << scheme << ": " << coarse << ", " << fine;
  }
}

// The arm turns nine times. The error is relative to the tip's lag behind the hub, at most 0.574 m in the fine
// solution.
TEST(SpeedRuns, SpinUpIsComparedInTheFrameOfTheHub) {
  const SpeedRun run = run_speed(kConfig, problem_named("spin_up"), {"em", 2, 4, 0.05});
  ASSERT_EQ(run.frames.size(), run.trajectory.size());
  EXPECT_NEAR(largest_displacement(run.trajectory), 0.57, 0.01);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    EXPECT_LT(run.frames[i].position.norm(), 1e-12);
    EXPECT_GT(run.trajectory[i].x(), 9.9);
  }
}

TEST(SpeedRuns, CountWhatTheyDid) {
  SpeedProblem problem = problem_named("double_pendulum");
  problem.until = 0.12;
  const Discretisation discretisation{"em", 2, 4, 0.01};
  const SpeedRun run = run_speed(kConfig, problem, discretisation);
  EXPECT_FALSE(run.failure);
  EXPECT_EQ(run.steps, 12);
  EXPECT_EQ(run.trajectory.size(), 3u);
  EXPECT_EQ(run.trajectory[0], Vector3(2, 0, 0));
  EXPECT_GT(run.seconds, 0);
  const SpeedRun full = run_speed(kConfig, problem, discretisation, false);
  EXPECT_EQ(full.factorisations, full.iterations);
  EXPECT_LT(trajectory_error(full.trajectory, run.trajectory), discretisation.tolerance);
}

TEST(SpeedRuns, RefuseWhatDoesNotFit) {
  const SpeedProblem pendulum = problem_named("double_pendulum");
  EXPECT_THROW(run_speed(kConfig, pendulum, {"em", 2, 3, 0.01}), std::invalid_argument);   // two equal beams
  EXPECT_THROW(run_speed(kConfig, pendulum, {"em", 2, 4, 0.025}), std::invalid_argument);  // interval 0.06 s
  EXPECT_THROW(run_speed("/nowhere", pendulum, {"em", 2, 4, 0.01}), std::runtime_error);
}

TEST(SpeedProblems, EveryRunCanBeMade) {
  for (const SpeedProblem& problem : speed_problems()) {
    const scene::ReadResult read = scene::read_scene_file(kConfig + "/" + problem.scene);
    EXPECT_TRUE(read.scene && read.diagnostics.empty()) << to_text(read.diagnostics);
    SpeedProblem start = problem;
    start.until = start.interval;
    std::set<std::string> seen;
    for (const Discretisation& run : problem.runs) {
      if (seen.insert(run.scheme + run.mesh()).second) {
        EXPECT_NO_THROW(run_speed(kConfig, start, run)) << problem.name << " " << run.scheme << " " << run.mesh();
      }
      const double steps = problem.interval / run.step;
      EXPECT_NEAR(steps, std::round(steps), 1e-9 * steps) << problem.name << " " << run.step;
    }
  }
}

SpeedOutcome outcome(const std::string& scheme, double step, double seconds, double error) {
  SpeedOutcome out;
  out.discretisation = {scheme, 2, 4, step};
  out.run.seconds = seconds;
  out.error = error;
  return out;
}

TEST(Fastest, IsAccurateSurelyAndNotByChance) {
  SpeedMeasurement m;
  m.mesh_error = 1e-4;
  m.step_error = 1e-4;
  m.outcomes = {outcome("em", 0.4, 1, 1e-2), outcome("em", 0.2, 2, 4e-3), outcome("em", 0.1, 4, 1e-3),
                outcome("m1", 0.4, 0.5, 1e-3), outcome("m1", 0.2, 3, 2e-2)};
  EXPECT_EQ(m.fastest(5e-3), &m.outcomes[1]) << "m1 met 1e-3 by chance";
  EXPECT_EQ(m.fastest(4.1e-3), &m.outcomes[2]) << "the reference may be wrong by 2e-4";
  EXPECT_EQ(m.fastest(3e-2, "m1"), &m.outcomes[3]);
  EXPECT_EQ(m.fastest(1e-3), nullptr);
  EXPECT_TRUE(m.resolves(4e-4));
  EXPECT_FALSE(m.resolves(3.9e-4));
  m.outcomes[2].run.failure = Failure{1, StepResult::Reason::NoConvergence};
  EXPECT_EQ(m.fastest(4.5e-3), nullptr) << "the next finer run fails";
}

TEST(FastestPeer, IsAccurateSurelyAndOfTheVariant) {
  SpeedMeasurement m;
  m.step_error = 1e-4;
  m.peers = {{"other", "RK4", 0, 0.1, 1, true, 1e-3},
             {"other", "RK4", 0, 0.05, 2, true, 5e-4},
             {"other", "Euler", 0, 0.01, 0.5, true, 1e-5},
             {"other", "RK4", 0, 0.02, 0.1, false, 0}};
  EXPECT_EQ(m.fastest_peer(1e-3, "RK4"), &m.peers[1]) << "the reference may be wrong by 1e-4";
  EXPECT_EQ(m.fastest_peer(1e-2, "RK4"), &m.peers[0]);
  EXPECT_EQ(m.fastest_peer(1e-4, "RK4"), nullptr);
}

TEST(RealTime, IsToldInTheUnitOfTheTarget) {
  RealTimeOutcome outcome;
  outcome.scene.until = 2;
  outcome.run.seconds = 0.01;
  outcome.run.steps = 2000;
  outcome.run.iterations = 5000;
  using Unit = RealTimeScene::Unit;
  for (const auto& [unit, expected] : {std::pair{Unit::TimesRealTime, 200.0},
                                       {Unit::MicrosecondsPerStep, 5.0},
                                       {Unit::MicrosecondsPerTwoIterations, 4.0}}) {
    outcome.scene.unit = unit;
    EXPECT_NEAR(outcome.measured(), expected, 1e-12 * expected);
  }
}

TEST(SpeedReport, HasEveryProblemAndFiniteNumbers) {
  double last = 0;
  const SpeedReport report = measure_speed(kConfig, speed_problems(), true, [&](double part, const std::string&) {
    EXPECT_GE(part, last);
    last = part;
  });
  EXPECT_NEAR(last, 1, 1e-9);
  const std::string text = to_markdown(report, "speed.png"), data = runs_to_csv(report);
  for (const SpeedProblem& problem : speed_problems()) {
    EXPECT_NE(text.find("\n## " + problem.title + "\n"), std::string::npos) << problem.name;
    EXPECT_NE(data.find("\n" + problem.name + ",reference,"), std::string::npos) << problem.name;
  }
  for (const SpeedTarget& target : speed_targets())
    EXPECT_NE(text.find("\n| " + target.problem + ", "), std::string::npos) << target.problem;
  for (const RealTimeScene& scene : real_time_scenes())
    EXPECT_NE(text.find("\n| " + scene.title + " ["), std::string::npos) << scene.title;
  EXPECT_NE(text.find("\n| six_joint_arm, 0.06 s [time over MuJoCo RK4's] "), std::string::npos);
  ASSERT_FALSE(report.batches.empty());
  for (const BatchComparison& batch : report.batches)
    EXPECT_NE(text.find("\n| " + batch.scene + " | "), std::string::npos) << batch.scene;
  EXPECT_NE(text.find("](speed.png)"), std::string::npos);
  for (const std::string& output : {text, data})
    for (const char* word : {"nan", "inf"}) EXPECT_EQ(output.find(word), std::string::npos) << word;
  for (const SpeedMeasurement& m : report.measurements) {
    EXPECT_TRUE(std::isfinite(m.reference_error())) << m.problem.name;
    for (const SpeedOutcome& run : m.outcomes) EXPECT_TRUE(std::isfinite(run.error)) << m.problem.name;
  }
}

}  // namespace
}  // namespace flexarm::bench
