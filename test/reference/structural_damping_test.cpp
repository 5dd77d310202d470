// Tests structural damping of the energy-momentum family: strong damping leaves no oscillation, and the energy account
// stays exact. (numerical_dissipation_spectrum_test tests its roots, dynamics_order_test its order.)
#include <cstdio>

#include "reference/documented_arms.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// The scheme's velocity of the shoulder of the guide's arm, whose motor torque jumps at 0 and at 1 s, every
/// millisecond from 1.05 to 1.5 s. The beam's modes above 2 / eta = 2000 rad/s creep. Slower modes that a step of 1 ms
/// does not resolve (1000 rad/s) decay at least with eta omega^2 / 2 = 500/s. So exp(-25) is left of the motion that
/// the jump at 1 s has excited.
std::vector<double> velocities_after_jump(const std::string& scheme, int refinement) {
  Simulation simulation(guide_arm(), options(scheme, 1e-3 / refinement));
  const int shoulder = model_of(simulation).joints[model_of(simulation).coordinates.front().joint].slave;
  std::vector<double> velocities;
  for (int n = 1; n <= 1500; ++n) {
    run(simulation, refinement);
    const NodeState& node = state_of(simulation).nodes[shoulder];
    if (n >= 1050) velocities.push_back((node.orientation * node.angular_velocity).z());
  }
  return velocities;
}

/// Root mean square of the distance of each value from the mean of its neighbours. An alternating part counts twice,
/// other parts with the square of their frequency.
double roughness(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    sum += std::pow(values[i] - 0.5 * (values[i - 1] + values[i + 1]), 2);
  return std::sqrt(sum / (values.size() - 2));
}

class StructuralDamping : public ::testing::TestWithParam<std::string> {};

// The step resolves all modes that still move. So the velocity is about as smooth as that in steps sixteen times
// shorter: the alternating part is smaller than the motion's own roughness. A dashpot at the middle of the step leaves
// six hundred times as much.
TEST_P(StructuralDamping, JumpOfATorqueLeavesNoRinging) {
  const double coarse = roughness(velocities_after_jump(GetParam(), 1)),
               fine = roughness(velocities_after_jump(GetParam(), 16));
  std::printf("%s: roughness %.3e rad/s, of a step sixteen times shorter %.3e\n", GetParam().c_str(), coarse, fine);
  EXPECT_LT(coarse, 2 * fine);
}

/// Steps of any length in any order, with strong damping, whose memory holds much of the energy.
void expect_exact_account(const std::string& scheme, bool is_even) {
  SceneBuilder b;
  scene::BeamDescription& beam = b.beam("arm", {{1, 0, 0}, {1.5, 0.3, 0}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 3, 2);
  beam.stiffness_proportional_damping = 0.1;
  if (!is_even) beam.damping_shares << 0, 0.3, 0.1, 0.5, 1, 0.2;
  b.body("hand", 0.8, {0.1, 0.05, -0.1}, 0.2 * Matrix3::Identity());
  b.joint("shoulder", scene::JointKind::Spherical, "world", "arm");
  b.joint("wrist", scene::JointKind::Fixed, "arm", "hand", {1.5, 0.3, 0});
  b.scene.gravity = {0, 0, -9.81};
  Simulation simulation(b.scene, options(scheme, 0.02, 1e-10));
  InvariantDrift drift(simulation);
  double dissipated = 0;
  for (int n = 0; n < 200; ++n) {
    State state = state_of(simulation);
    state.halving_level = n % 4;
    restore(simulation, state);
    ASSERT_TRUE(simulation.step().converged);
    drift.observe();
    EXPECT_GE(simulation.energies().dissipated, dissipated);
    dissipated = simulation.energies().dissipated;
  }
  EXPECT_GT(dissipated, 0);
  EXPECT_LT(drift.energy(), 1e-10);  // round-off: Newton's last iteration squares its tolerance
}

TEST_P(StructuralDamping, AccountIsExactInHalvedSteps) {
  expect_exact_account(GetParam(), true);
}
TEST_P(StructuralDamping, AccountIsExactWhereStrainsAreDampedOneByOne) {
  expect_exact_account(GetParam(), false);
}
INSTANTIATE_TEST_SUITE_P(Schemes, StructuralDamping, ::testing::Values("em", "em_symmetric", "edmc2"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace flexarm::test
