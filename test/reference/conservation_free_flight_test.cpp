// Invariants of free flight (reference case D1) over ten thousand steps.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {
namespace {

constexpr int kSteps = 10000;
constexpr double kEnergyTolerance = 1e-9, kMomentumTolerance = 1e-10;

/// A bent, flexible beam that tumbles about no principal axis, so that it must bend and twist.
SceneBuilder tumbling_beam() {
  SceneBuilder b;
  b.beam("beam", {{3, 0, 0}, {5, 2, 1}}, soft_section(), 2, 2);
  b.joint("free", scene::JointKind::Floating, "world", "beam");
  initial_field(b, "beam", Vector3::Zero(), {0.8, 1.5, -1.1});
  set_drift(b, {0.003, -0.001, 0.002});
  return b;
}

void expect_conserved(const SceneBuilder& builder, const std::string& scheme, double step, bool energy) {
  Simulation simulation(builder.scene, options(scheme, step, 1e-10));
  InvariantDrift drift(simulation);
  double strain = 0;
  run(simulation, kSteps, [&] {
    drift.observe();
    strain = std::max(strain, simulation.energies().strain);
  });
  EXPECT_GT(strain, 0.01 * simulation.energies().total()) << "it must bend";
  if (energy) {
    EXPECT_LT(drift.energy(), kEnergyTolerance) << scheme;
  }
  EXPECT_LT(drift.momentum(), kMomentumTolerance) << scheme;
  EXPECT_LT(drift.angular_momentum(), kMomentumTolerance) << scheme;
  std::printf("%s: drift of energy %.1e, momentum %.1e, angular momentum %.1e\n", scheme.c_str(), drift.energy(),
              drift.momentum(), drift.angular_momentum());
}

TEST(FreeFlight, TumblingBeamWithEm) {
  expect_conserved(tumbling_beam(), "em", 0.05, true);
}
TEST(FreeFlight, TumblingBeamMomentaWithEm0) {
  expect_conserved(tumbling_beam(), "em0", 0.05, false);
}
TEST(FreeFlight, TumblingBeamMomentaWithM1) {
  expect_conserved(tumbling_beam(), "m1", 0.05, false);
}
TEST(FreeFlight, TreeOfBeamsWithEm) {
  expect_conserved(free_beam_tree(), "em", 0.02, true);
}

class FreeTree : public ::testing::TestWithParam<scene::JointKind> {};

TEST_P(FreeTree, ConservesWithEveryKindOfJoint) {
  for (const std::string scheme : {"em", "em0", "m1"}) {
    Simulation simulation(free_tree(GetParam()).scene, options(scheme, 0.02, 1e-10));
    InvariantDrift drift(simulation);
    run(simulation, 300, [&] { drift.observe(); });
    if (scheme == "em") {
      EXPECT_LT(drift.energy(), 1e-10);
    }
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(JointKinds, FreeTree,
                         ::testing::Values(scene::JointKind::Fixed, scene::JointKind::Revolute,
                                           scene::JointKind::Continuous, scene::JointKind::Prismatic,
                                           scene::JointKind::Planar, scene::JointKind::Floating,
                                           scene::JointKind::Spherical, scene::JointKind::Universal,
                                           scene::JointKind::Cylindrical));

// The control group: what the bounds above would catch.
TEST(FreeFlight, NewmarkDriftsVisibly) {
  Simulation simulation(tumbling_beam().scene, options("newmark", 0.05));
  InvariantDrift drift(simulation);
  run(simulation, 1000, [&] { drift.observe(); });
  EXPECT_GT(drift.energy(), 1e-6);
  EXPECT_GT(drift.angular_momentum(), 1e-6);
}

TEST(FreeFlight, Em0KeepsItsEnergyOnlyApproximately) {
  Simulation simulation(tumbling_beam().scene, options("em0", 0.05));
  InvariantDrift drift(simulation);
  run(simulation, 1000, [&] { drift.observe(); });
  EXPECT_GT(drift.energy(), 1e-8);
}

}  // namespace
}  // namespace flexarm::test
