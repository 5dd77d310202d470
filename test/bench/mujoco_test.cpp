// Compares flexarm with MuJoCo, which shares no code with it, on the same problems.
#include "bench/mujoco.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/speed.h"
#include "flexarm/scene/urdf_reader.h"
#include "support/scene_builder.h"
#include "support/source_path.h"

namespace flexarm::bench {
namespace {

const std::vector<double> kTimes = {1, 2, 3};

std::vector<PeerRun> quick_runs(PeerProblem problem, const std::vector<double>& times) {
  return mujoco_runs(problem, times, true, [] {});
}

const PeerRun& run_of(const std::vector<PeerRun>& runs, const std::string& variant, double step) {
  for (const PeerRun& run : runs)
    if (run.variant == variant && run.step == step) return run;
  throw std::invalid_argument(variant);
}

std::vector<Vector3> pendulum_by_flexarm() {
  test::SceneBuilder b;
  const scene::DirectSection section = test::section(1e5, 5e4, 20, 20, 1, 2e-4, 1e-4);
  b.scene.gravity = Vector3(0, 0, -9.81);
  b.beam("upper", {{1, 0, 0}}, section, 4, 2);
  b.beam("lower", {{1, 0, 0}}, section, 4, 2);
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.joint("elbow", scene::JointKind::Revolute, "upper", "lower", {1, 0, 0}, Vector3::UnitY());
  b.probe("tip", "lower", {1, 0, 0});
  SimulationOptions options;
  options.step = 2e-3;
  Simulation simulation(b.scene, options);
  std::vector<Vector3> tip;
  for (const double time : kTimes) {
    while (simulation.time() < time - 1e-9)
      if (!simulation.step().converged) throw std::runtime_error("flexarm failed");
    tip.push_back(simulation.probe(0).pose.position);
  }
  return tip;
}

TEST(MuJoCo, SwingsTheDoublePendulumAsFlexarmDoes) {
  const std::vector<PeerRun> runs = quick_runs(PeerProblem::DoublePendulum, kTimes);
  if (runs.empty()) GTEST_SKIP() << "built without MuJoCo";
  const std::vector<Vector3> expected = pendulum_by_flexarm();
  const PeerRun& run = run_of(runs, "RK4", 1e-3);
  ASSERT_TRUE(run.completed);
  ASSERT_EQ(run.probe.size(), kTimes.size());
  // Tolerance relative to the pendulum's length. A chain of n rigid parts has an error of 1/n^2 of the bending, 6 %.
  // The bending is less than half of the length.
  for (std::size_t i = 0; i < kTimes.size(); ++i)
    EXPECT_LT((run.probe[i] - expected[i]).norm(), 0.03 * 2) << "at " << kTimes[i] << " s";
  EXPECT_GT(run.seconds, 0);
}

TEST(MuJoCo, SwingsTheRigidArmAsFlexarmDoes) {
  const std::string config = test::source_path("config");
  const scene::ReadResult read = scene::read_scene_file(config + "/speed/six_joint_arm.urdf");
  ASSERT_TRUE(read.scene);
  const std::vector<PeerRun> runs = mujoco_runs_of(*read.scene, {0, 0.5, 1}, true);
  if (runs.empty()) GTEST_SKIP() << "built without MuJoCo";
  const PeerRun& run = run_of(runs, "RK4", 1e-3);
  ASSERT_TRUE(run.completed);
  SpeedProblem problem;
  for (const SpeedProblem& known : speed_problems())
    if (known.name == "six_joint_arm") problem = known;
  problem.interval = 0.5;
  const Trajectory coarse = run_speed(config, problem, {"em4", 0, 0, 0.01}).trajectory,
                   fine = run_speed(config, problem, {"em4", 0, 0, 0.005}).trajectory;
  EXPECT_LT((run.probe[0] - fine[0]).norm(), 1e-14);
  // With fourth order, the finer run has an error of a fifteenth of the difference. MuJoCo's run is five times finer,
  // so its error is smaller.
  for (std::size_t i = 1; i < fine.size(); ++i)
    EXPECT_LT((run.probe[i] - fine[i]).norm(), 0.2 * (coarse[i] - fine[i]).norm()) << i;
}

TEST(MuJoCo, SaysWhereItBlowsUpAndWhereItIsDamped) {
  const std::vector<PeerRun> runs = quick_runs(PeerProblem::DoublePendulum, {1});
  if (runs.empty()) GTEST_SKIP() << "built without MuJoCo";
  const PeerRun &undamped = run_of(runs, "Euler", 1e-2), &damped = run_of(runs, "Euler, damping h/2 EI/l", 1e-2);
  // Segments of l = 1/4 m rotate against each other with omega^2 = 4 (EI / l) / (m l^3 / 12 + 1e-4 l): omega h = 4.9 >
  // 2.
  EXPECT_FALSE(undamped.completed);
  EXPECT_TRUE(undamped.probe.empty());
  EXPECT_TRUE(damped.completed);
  EXPECT_EQ(damped.probe.size(), 1u);
}

TEST(MuJoCo, TurnsTheHubByThePrescribedAngle) {
  // At 20 s the hub's angle is 6 t - 45, and the beam only trembles. It is stiffened by centrifugal forces and bends by
  // a few millimetres.
  const std::vector<PeerRun> runs = quick_runs(PeerProblem::SpinUp, {20});
  if (runs.empty()) GTEST_SKIP() << "built without MuJoCo";
  for (const PeerRun& run : runs) {
    ASSERT_TRUE(run.completed) << run.variant << " " << run.step;
    const Vector3 straight(10 * std::cos(75.0), 10 * std::sin(75.0), 0);
    EXPECT_LT((run.probe[0] - straight).norm(), 0.02) << run.variant << " " << run.step;
  }
}

}  // namespace
}  // namespace flexarm::bench
