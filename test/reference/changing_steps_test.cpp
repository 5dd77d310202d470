// Tests that a scheme conserves the same quantities in steps of changing length as in equal steps.
#include "reference/dynamics_joint_chain.h"
#include "schemes/scheme.h"

namespace flexarm::test {
namespace {

constexpr double kLargestStep = 0.02;

/// Irregular step lengths, from a tenth of the largest step to the whole one. Each length holds for a few steps.
double step_at(int n) {
  const double wave = std::sin(1.7 * (n / 7)) + std::sin(0.61 * (n / 7));
  return kLargestStep * (0.55 + 0.225 * wave);
}

/// Expects the conservation of equal steps; see FreeFlight and FreeTree.
void expect_conserved(const SceneBuilder& builder, const Scheme& scheme, int steps, double momentum_tolerance) {
  Simulation simulation(builder.scene, options(std::string(scheme.name), kLargestStep, 1e-10));
  InvariantDrift drift(simulation);
  double end = 0;
  for (int n = 0; n < steps; ++n) {
    simulation.set_step_size(step_at(n));
    end += step_at(n);
    ASSERT_TRUE(simulation.step().converged) << scheme.name << " at " << simulation.time();
    drift.observe();
  }
  EXPECT_NEAR(simulation.time(), end, 1e-12 * steps);
  if (scheme.conserves_energy || scheme.dissipation.any()) {
    EXPECT_LT(drift.energy(), 1e-10) << scheme.name;
  }
  EXPECT_LT(drift.momentum(), momentum_tolerance) << scheme.name;
  EXPECT_LT(drift.angular_momentum(), momentum_tolerance) << scheme.name;
}

TEST(ChangingSteps, KeepEnergyAndMomentaOfEveryScheme) {
  for (const Scheme& scheme : schemes())
    if (scheme.conserves_momenta)
      for (const scene::JointKind kind : {scene::JointKind::Spherical, scene::JointKind::Prismatic})
        expect_conserved(free_tree(kind), scheme, 300, 1e-11);
}

TEST(ChangingSteps, KeepThemOverTenThousandSteps) {
  SceneBuilder tree = free_tree(scene::JointKind::Revolute);
  set_drift(tree, {0.002, -0.001, 0.003});
  expect_conserved(tree, *find_scheme("em"), 10000, 1e-10);
}

}  // namespace
}  // namespace flexarm::test
