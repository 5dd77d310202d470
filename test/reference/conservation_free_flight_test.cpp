// Tests the invariants of free flight (reference case D1) over ten thousand steps.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "schemes/scheme.h"

namespace flexarm::test {
namespace {

constexpr int kFlightSteps = 10000;
constexpr double kEnergyTolerance = 1e-9, kMomentumTolerance = 1e-10;

void expect_conserved(const SceneBuilder& builder, const std::string& scheme, double step, bool energy) {
  Simulation simulation(builder.scene, options(scheme, step, 1e-10));
  InvariantDrift drift(simulation);
  double strain = 0;
  run(simulation, kFlightSteps, [&] {
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

/// Every scheme that claims to conserve momenta, or energy too, with every kind of joint.
class FreeTree : public ::testing::TestWithParam<std::tuple<Scheme, scene::JointKind>> {};

const std::vector<Scheme>& conserving_schemes() {
  static const std::vector<Scheme> list = [] {
    std::vector<Scheme> out;
    for (const Scheme& scheme : schemes())
      if (scheme.conserves_momenta) out.push_back(scheme);
    return out;
  }();
  return list;
}

TEST_P(FreeTree, ConservesWithEveryKindOfJoint) {
  const auto [scheme, kind] = GetParam();
  Simulation simulation(free_tree(kind).scene, options(std::string(scheme.name), 0.02, 1e-10));
  InvariantDrift drift(simulation);
  run(simulation, 300, [&] { drift.observe(); });
  if (scheme.conserves_energy || scheme.dissipation.any()) {
    EXPECT_LT(drift.energy(), 1e-10);  // of total energy + dissipation
  }
  EXPECT_LT(drift.momentum(), 1e-11);
  EXPECT_LT(drift.angular_momentum(), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Joints, FreeTree,
                         ::testing::Combine(::testing::ValuesIn(conserving_schemes()), ::testing::ValuesIn([] {
                                              std::vector<scene::JointKind> kinds;
                                              for (const auto& traits : named_joint_kinds())
                                                kinds.push_back(traits.kind);
                                              return kinds;
                                            }())),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + "_" +
                                  scene::traits_of(std::get<1>(info.param)).name;
                         });

// The scheme table lists these claims. A scheme that loses or gains a claim fails here.
TEST(FreeFlight, ClaimsOfTheTable) {
  std::string energy, momenta;
  for (const Scheme& scheme : schemes()) {
    if (scheme.conserves_energy) energy += std::string(scheme.name) + " ";
    if (scheme.conserves_momenta) momenta += std::string(scheme.name) + " ";
  }
  EXPECT_EQ(energy, "em em_symmetric em4 std beta1 beta2 beta1_repaired beta2_repaired ");
  EXPECT_EQ(momenta, "em em0 em_symmetric em4 edmc1 edmc2 m1 m2 std beta1 beta2 beta1_repaired beta2_repaired ");
}

/// Number of steps of 20 ms, at most `most`, that a tree with three times the spin takes before it fails.
int steps_of_fast_tree(const std::string& scheme, scene::JointKind kind, int most) {
  SceneBuilder b = free_tree(kind);
  b.scene.initial_links.front().angular *= 3;
  b.scene.integrator.max_halvings = 5;  // steps of 0.6 ms
  Simulation simulation(b.scene, options(scheme, 0.02, 1e-10));
  InvariantDrift drift(simulation);
  int steps = 0;
  for (; steps < most && simulation.step().converged; ++steps) drift.observe();
  // Until it fails, the motion conserves exactly.
  EXPECT_LT(drift.energy(), 1e-10) << scheme;
  EXPECT_LT(drift.momentum(), 1e-11) << scheme;
  EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  std::printf("%s: %d steps\n", scheme.c_str(), steps);
  return steps;
}

// The thesis's correction by axial and shear forces alone (6.22, 6.26) has a denominator that vanishes when the axial
// and shear strains of an element pause. Then Newton's method fails, even in steps of 0.6 ms. The denominator of the
// repaired correction also contains the curvatures, so it does not fail.
TEST(FreeFlight, ThesisCorrectionFailsWhereTheRepairedOneDoesNot) {
  using scene::JointKind;
  for (const JointKind kind : {JointKind::Fixed, JointKind::Revolute})
    for (const std::string scheme : {"beta1", "beta2"}) {
      EXPECT_LT(steps_of_fast_tree(scheme, kind, 300), 300);
      EXPECT_EQ(steps_of_fast_tree(scheme + "_repaired", kind, 300), 300);
    }
}

// Shows that the bounds above detect a scheme that does not conserve.
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
