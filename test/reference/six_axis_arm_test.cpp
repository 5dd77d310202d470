// Tests a whole robot: the six-axis arm of config/examples, with a flexible forearm, elastic gears and servos with
// integrals.
#include <gtest/gtest.h>

#include <array>

#include "flexarm/scene/urdf_reader.h"
#include "reference/dynamics_runs.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

constexpr int kAxes = 6;
constexpr double kSecond = 1000;  // steps per second

class SixAxisArm : public testing::Test {
 protected:
  SixAxisArm() : read_(scene::read_scene_file(source_path("config/examples/six_axis_arm.urdf"))) {}

  std::array<double, kAxes> positions(const Simulation& simulation) const {
    std::array<double, kAxes> out;
    for (int i = 0; i < kAxes; ++i) out[i] = simulation.position(i);
    return out;
  }
  double set_point(int axis, double time) const { return (*read_.scene->servos[axis].set_point)(time); }

  scene::ReadResult read_;
};

TEST_F(SixAxisArm, IsReadAndStartsWithoutAnyFinding) {
  ASSERT_TRUE(read_.scene);
  EXPECT_TRUE(read_.diagnostics.empty()) << to_text(read_.diagnostics);
  EXPECT_TRUE(Simulation(*read_.scene).start_warnings().empty());
}

// The motors are at their set points. The links are behind gears that are twisted by their loads.
TEST_F(SixAxisArm, HoldsItsPoseUnderGravity) {
  ASSERT_TRUE(read_.scene);
  Simulation simulation(*read_.scene);
  const std::array<double, kAxes> start = positions(simulation);
  for (int i = 0; i < kAxes; ++i) simulation.command_set_point(i, set_point(i, 0));
  run(simulation, static_cast<int>(kSecond));
  for (int i = 0; i < kAxes; ++i) {
    const double twist = -simulation.effort(i) / *read_.scene->drives[i].stiffness;
    EXPECT_NEAR(simulation.position(i), set_point(i, 0) + twist, 1e-10) << i;
    EXPECT_NEAR(simulation.position(i), start[i], 1e-10) << i;
  }
  EXPECT_LT(simulation.effort(1), -30) << "axis 2 carries some 15 kg before it";
}

// In slowly moving stiff links, em's multiplier is only round-off. Iterations must end there, also with kept factors.
// Predictions are already right to round-off, and two or three updates show that updates do not decrease.
TEST_F(SixAxisArm, RoundOffCostsNoIterations) {
  ASSERT_TRUE(read_.scene);
  for (const char* scheme : {"em", "em0", "edmc2"}) {
    Simulation simulation(*read_.scene, options(scheme));
    StepCounts counts;
    for (int n = 0; n < kSecond; ++n) counts.add(simulation.step());
    EXPECT_LE(static_cast<double>(counts.iterations), 4 * kSecond) << scheme;
    EXPECT_LE(counts.other_guesses, kSecond / 100) << scheme;
  }
}

TEST_F(SixAxisArm, FollowsItsTrajectoryAndClosesItsEnergyAccount) {
  ASSERT_TRUE(read_.scene);
  Simulation simulation(*read_.scene);
  std::array<double, kAxes> error{}, effort{}, change{};
  std::array<double, kAxes> held;
  double imbalance = 0;
  const double account = energy_account(simulation);
  ASSERT_TRUE(simulation.step().converged);
  for (int i = 0; i < kAxes; ++i) held[i] = simulation.effort(i);
  run(simulation, static_cast<int>(5 * kSecond) - 1, [&] {
    for (int i = 0; i < kAxes; ++i) {
      error[i] = std::max(error[i], std::abs(simulation.position(i) - set_point(i, simulation.time())));
      effort[i] = std::max(effort[i], std::abs(simulation.effort(i)));
      change[i] = std::max(change[i], std::abs(simulation.effort(i) - held[i]));
    }
    imbalance = std::max(imbalance, std::abs(energy_account(simulation) - account));
  });
  for (int i = 0; i < kAxes; ++i) {
    // The motion is slow compared with the servos. kp and the gear act as springs in series: kp for the change of the
    // effort since the start, the gear for the whole transmitted effort.
    const double bound = change[i] / read_.scene->servos[i].kp + effort[i] / *read_.scene->drives[i].stiffness;
    EXPECT_LT(error[i], bound) << i;
    EXPECT_GT(std::abs(set_point(i, 5) - set_point(i, 0)), 100 * bound) << i << ": it has moved";
  }
  EXPECT_LT(imbalance, 1e-9 * std::abs(simulation.energies().work));
}

}  // namespace
}  // namespace flexarm::test
