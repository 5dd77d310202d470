// Tests that Newton's method converges quadratically in a step with large rotations, so that its tangent is the
// derivative of the residual.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Exponent p of e_{k+1} = e_k^p for the last pair of scaled updates above round-off. In the limit it is 2, up to a
/// constant factor.
double observed_exponent(const std::vector<double>& norms) {
  double exponent = 0;
  for (std::size_t k = 0; k + 1 < norms.size(); ++k)
    if (norms[k] < 0.05 && norms[k + 1] > 1e-13) exponent = std::log(norms[k + 1]) / std::log(norms[k]);
  return exponent;
}

void expect_quadratic(const std::vector<double>& norms, const std::string& what) {
  std::printf("%-28s", what.c_str());
  for (const double norm : norms) std::printf(" %.1e", norm);
  std::printf("\n");
  ASSERT_GE(norms.size(), 4u) << "the step must be large enough to show the rate";
  EXPECT_GT(observed_exponent(norms), 1.7) << what;
}

class Newton : public ::testing::TestWithParam<std::string> {};

TEST_P(Newton, QuadraticOnALargeStepOfAFlexibleBeam) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}, {1.5, 0.5, 0.3}}, soft_section(), 2, 2);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {1.5, 0.5, 0.3}, {20, 10, 60}, {5, 10, 5});
  b.load("arm", {1.5, 0.5, 0.3}, {0, 0, 10}, Vector3::Zero(), "1", scene::LoadFrame::Follower);
  Simulation simulation(b.scene, full_newton(options(GetParam(), 0.15, 1e-12)));
  ASSERT_EQ(simulation.step().halvings, 0);
  expect_quadratic(update_norms_of(simulation), GetParam() + " beam");
}

TEST_P(Newton, QuadraticWithEveryKindOfJoint) {
  for (const scene::JointKindTraits& traits : named_joint_kinds()) {
    SceneBuilder b = free_tree(traits.kind);
    b.scene.initial_links[0].angular *= 3;
    b.load("hand", {0.2, 0.1, 0}, {3, 6, 2}, {0.3, 0.6, 0.3});
    for (scene::JointDescription& joint : b.scene.joints) joint.damping = 0.3;
    Simulation simulation(b.scene, full_newton(options(GetParam(), 0.1, 1e-12)));
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged);
    ASSERT_EQ(result.halvings, 0) << traits.name;
    expect_quadratic(update_norms_of(simulation), GetParam() + " " + traits.name);
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, Newton, ::testing::Values("em", "em0", "m1", "newmark"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace flexarm::test
