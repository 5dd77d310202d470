// Tests wrenches that are applied from outside: their effect, how the state keeps them, and which are refused.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "flexarm/simulation/checkpoint.h"
#include "schemes/scheme.h"
#include "simulation/body_with_beam.h"
#include "simulation/everything_scene.h"
#include "simulation/same_bits.h"
#include "support/runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

const Vector3 kPoint(0.5, 0.1, -0.2), kForce(1, 2, -0.5), kMoment(0.1, -0.2, 0.05);

AppliedWrench wrench_on(const Simulation& simulation, const std::string& link, const Vector3& at, bool follows) {
  return {link_of(simulation, link), at, {kForce, kMoment}, follows};
}

class Wrenches : public ::testing::TestWithParam<std::string> {};

// A wrench acts like a load of the scene at the same point. Where the beam has a node, a load does not change its mesh.
TEST_P(Wrenches, ActAsLoadsOfTheScene) {
  for (const bool follows : {false, true})
    for (const auto& [link, at] : {std::pair<std::string, Vector3>{"body", kPoint}, {"beam", {0.75, 0, 0}}}) {
      const SimulationOptions options = test::options(GetParam());
      SceneBuilder loaded = body_with_beam();
      loaded.load(link, at, kForce, kMoment, "1", follows ? scene::LoadFrame::Follower : scene::LoadFrame::World);
      Simulation expected(loaded.scene, options), simulation(body_with_beam().scene, options);
      simulation.apply_wrenches({wrench_on(simulation, link, at, follows)});
      for (int n = 0; n < 50; ++n) {
        ASSERT_TRUE(expected.step().converged);
        ASSERT_TRUE(simulation.step().converged);
      }
      const double work = expected.energies().work;
      EXPECT_GT(std::abs(work), 1e-3);
      // Tolerance: Newton's tolerance in the work of each step, and round-off of a different order of summation.
      EXPECT_NEAR(simulation.energies().work, work, 1e-6 * std::abs(work)) << link << follows;
      EXPECT_LT((simulation.tip_pose(2).position - expected.tip_pose(2).position).norm(), 1e-7) << link << follows;
    }
}

// Wrenches on one link add up, each call replaces the wrenches of the last one, and without any the motion is the
// original one.
TEST_P(Wrenches, AddUpAndGo) {
  const SimulationOptions options = test::options(GetParam());
  Simulation once(body_with_beam().scene, options), twice(body_with_beam().scene, options),
      none(body_with_beam().scene, options);
  AppliedWrench wrench = wrench_on(once, "body", kPoint, false);
  once.apply_wrenches({wrench});
  wrench.wrench.force /= 2;
  wrench.wrench.moment /= 2;
  twice.apply_wrenches({wrench, wrench});
  none.apply_wrenches({wrench});
  none.apply_wrenches({});
  Simulation untouched(body_with_beam().scene, options);
  for (int n = 0; n < 20; ++n) {
    for (Simulation* simulation : {&once, &twice, &none, &untouched}) ASSERT_TRUE(simulation->step().converged);
    EXPECT_LT((once.tip_pose(2).position - twice.tip_pose(2).position).norm(), 1e-9);
  }
  EXPECT_TRUE(same_bits(state_of(none), state_of(untouched)));
}

INSTANTIATE_TEST_SUITE_P(Schemes, Wrenches, ::testing::Values("em", "em0", "std", "edmc2", "m1"));

// The Newmark family keeps the acceleration at the beginning of a step. It does not contain a wrench that begins there,
// as with any load that jumps. This is an error of first order: in rates, 1 - gamma times the effect of the wrench over
// a step.
TEST(AppliedWrenches, JumpInNewmarksFamily) {
  for (const char* scheme : {"newmark", "hht2"}) {
    const auto error = [&](int steps) {
      const SimulationOptions options = test::options(scheme, 0.1 / steps);
      SceneBuilder loaded = body_with_beam();
      loaded.load("body", kPoint, kForce, kMoment);
      Simulation expected(loaded.scene, options), simulation(body_with_beam().scene, options);
      simulation.apply_wrenches({wrench_on(simulation, "body", kPoint, false)});
      for (int n = 0; n < steps; ++n)
        if (!expected.step().converged || !simulation.step().converged) ADD_FAILURE();
      return (simulation.tip_pose(2).position - expected.tip_pose(2).position).norm();
    };
    EXPECT_NEAR(std::log2(error(50) / error(100)), 1, 0.1) << scheme;
  }
}

// Wrenches are part of the state: a restored run continues with them, and a reset removes them.
TEST(AppliedWrenches, AreKeptInTheState) {
  const std::string path = ::testing::TempDir() + "flexarm_wrenches_test.state";
  const SimulationOptions options = full_newton();
  Simulation simulation(everything_scene().scene, options), resumed(everything_scene().scene, options);
  const State initial = state_of(simulation);
  simulation.apply_wrenches(
      {wrench_on(simulation, "beam3", {0.3, 0, 0}, true), wrench_on(simulation, "spherical_body", kPoint, false)});
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
  write_checkpoint(simulation, path);
  read_checkpoint(resumed, path);
  for (int n = 0; n < 10; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    ASSERT_TRUE(resumed.step().converged);
  }
  EXPECT_TRUE(same_bits(state_of(resumed), state_of(simulation)));
  EXPECT_EQ(state_of(resumed).wrenches.size(), 2u);
  simulation.reset();
  EXPECT_TRUE(same_bits(state_of(simulation), initial));
  EXPECT_TRUE(state_of(simulation).wrenches.empty());
  std::remove(path.c_str());
}

TEST(AppliedWrenches, CloseTheEnergyAccount) {
  Simulation simulation(body_with_beam().scene);
  simulation.apply_wrenches(
      {wrench_on(simulation, "body", kPoint, true), wrench_on(simulation, "beam", {1, 0, 0}, false)});
  double scale = 0;
  for (int n = 0; n < 500; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    scale = std::max(scale, std::abs(simulation.energies().kinetic));
  }
  const Energies energies = simulation.energies();
  EXPECT_LT(std::abs(energies.total() - energies.work), 1e-10 * scale);
}

TEST(AppliedWrenches, ThatCannotActAreRefused) {
  Simulation simulation(body_with_beam().scene);
  const AppliedWrench good = wrench_on(simulation, "body", kPoint, false);
  simulation.apply_wrenches({good});
  AppliedWrench bad = good;
  bad.wrench.force.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(simulation.apply_wrenches({good, bad}), std::invalid_argument);
  bad = good;
  bad.link = link_of(simulation, "world");
  EXPECT_THROW(simulation.apply_wrenches({bad}), std::invalid_argument);
  bad.link = 99;
  EXPECT_THROW(simulation.apply_wrenches({bad}), std::out_of_range);
  EXPECT_EQ(state_of(simulation).wrenches.size(), 1u);
}

}  // namespace
}  // namespace flexarm::test
