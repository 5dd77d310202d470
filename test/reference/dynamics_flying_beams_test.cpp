// Tests flying spaghetti and scissors of Simo and Vu-Quoc (1986, 1988), reference cases D2 to D4.
#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

enum { kLoadedEnd, kFreeEnd };

scene::DirectSection spaghetti_section(double ei) {
  return {1e4, 1e4, 1e4, 500, ei, ei, 1, 10, 10, 10};
}

/// A free beam from (6, 0) to (0, 8), loaded at its lower end by forces and moments that follow `history`.
SceneBuilder spaghetti(double ei, int elements, const Vector3& moment, const std::string& history) {
  SceneBuilder b;
  b.beam("beam", {{-6, 8, 0}}, spaghetti_section(ei), elements, 2);
  b.joint("free", JointKind::Floating, "world", "beam", {6, 0, 0});
  b.load("beam", {0, 0, 0}, {std::abs(moment.z()) / 10, 0, 0}, moment, history);
  b.probe("loaded end", "beam", {0, 0, 0});
  b.probe("free end", "beam", {-6, 8, 0});
  return b;
}
SceneBuilder plane_spaghetti(int elements) {
  SceneBuilder b = spaghetti(100, elements, {0, 0, -80}, "t < 2.5 ? 1 : 0");
  return b;
}
/// Moments M2 = 200 about the vertical at the peak, M3 = M2 / 2.
SceneBuilder space_spaghetti(int elements) {
  SceneBuilder b;
  b.beam("beam", {{-6, 8, 0}}, spaghetti_section(500), elements, 2);
  b.joint("free", JointKind::Floating, "world", "beam", {6, 0, 0});
  b.load("beam", {0, 0, 0}, {20, 0, 0}, {0, -100, -200}, "0:0 2.5:1 5:0");
  return b;
}

Vector3 end_position(const Simulation& s, int probe) {
  return s.probe(probe).pose.position;
}

// The spectral reference of D2 has loads that jump. Its own digits scatter by 1 % of L, so the tolerance is 2 %.
TEST(FlyingSpaghetti, PlaneAgreesWithTheSpectralReference) {
  Simulation simulation(plane_spaghetti(10).scene, options("em", 0.025));
  run(simulation, 100);
  EXPECT_LT((end_position(simulation, kLoadedEnd) - Vector3(4.950, 4.472, 0)).norm(), 0.2);
  EXPECT_LT((end_position(simulation, kFreeEnd) - Vector3(3.585, 6.110, 0)).norm(), 0.2);
  run(simulation, 1);
  EXPECT_NEAR(simulation.angular_momentum().z(), -229.424, 0.005 * 229.424);
  EXPECT_NEAR(simulation.energies().total(), 378.828, 0.02 * 378.828);
  EXPECT_NEAR(simulation.energies().total(), simulation.energies().work, 1e-8);
}

TEST(FlyingSpaghetti, PlaneConservesAfterTheLoad) {
  Simulation simulation(plane_spaghetti(6).scene, options("em", 0.05, 1e-10));
  run(simulation, 50);
  EXPECT_NEAR(simulation.momentum().x(), 20, 1e-10 * 20) << "impulse 8 N * 2.5 s";
  InvariantDrift drift(simulation);
  run(simulation, 400, [&] {
    drift.observe();
    EXPECT_NEAR(simulation.momentum().z(), 0, 1e-10) << "it stays in its plane";
  });
  EXPECT_LT(drift.energy(), 1e-9);
  EXPECT_LT(drift.momentum(), 1e-10);
  EXPECT_LT(drift.angular_momentum(), 1e-9) << "about a point from which it flies away";
}

TEST(FlyingSpaghetti, SpaceRunsHundredSecondsAtLargeSteps) {
  Simulation simulation(space_spaghetti(6).scene, options("em", 0.1, 1e-10));
  int halvings = 0;
  const auto advance = [&](int steps, InvariantDrift* drift) {
    for (int n = 0; n < steps; ++n) {
      const StepResult result = simulation.step();
      ASSERT_TRUE(result.converged) << "t = " << simulation.time() << ": " << to_string(result.reason);
      halvings += result.halvings;
      if (drift) drift->observe();
    }
  };
  advance(50, nullptr);
  // The midpoint rule integrates the triangular load exactly, since its kink is at the end of a step.
  EXPECT_LT((simulation.momentum() - Vector3(50, 0, 0)).norm(), 1e-10 * 50);
  InvariantDrift drift(simulation);
  advance(950, &drift);
  EXPECT_LT(drift.energy(), 1e-9) << halvings << " halvings";
  EXPECT_LT(drift.momentum(), 1e-10);
  EXPECT_LT(drift.angular_momentum(), 1e-9);
}

// Two links of length 5 with a hinge in the middle, loaded at the end of the second link.
TEST(FlyingScissors, ConserveAfterTheLoad) {
  SceneBuilder b;
  b.beam("first", {{-3, 4, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e6, 1e4, 1e4, 1, 10, 10, 10}, 3, 2);
  b.beam("second", {{3, -4, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e6, 1e4, 1e4, 1, 1, 1, 1}, 3, 2);
  b.joint("free", JointKind::Floating, "world", "second", {3, 4, 0});
  b.joint("hinge", JointKind::Revolute, "second", "first", {0, 0, 0}, Vector3::UnitZ());
  b.load("second", {3, -4, 0}, {40, 0, 0}, {0, 0, -160}, "t < 0.5 ? 1 : 0");
  Simulation simulation(b.scene, options("em", 0.025, 1e-10));
  run(simulation, 20);
  EXPECT_LT((simulation.momentum() - Vector3(20, 0, 0)).norm(), 1e-10 * 20) << "impulse 40 N * 0.5 s";
  EXPECT_NEAR(simulation.energies().total(), simulation.energies().work, 1e-9 * simulation.energies().work);
  InvariantDrift drift(simulation);
  run(simulation, 380, [&] { drift.observe(); });
  EXPECT_GT(std::abs(simulation.position(*simulation.find_coordinate("hinge"))), 1.0) << "the hinge opens";
  EXPECT_LT(drift.energy(), 1e-9);
  EXPECT_LT(drift.momentum(), 1e-10);
  EXPECT_LT(drift.angular_momentum(), 1e-9);
}

}  // namespace
}  // namespace flexarm::test
