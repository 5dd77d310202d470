// Tests that tip histories converge with the order of each scheme to an extrapolated reference.
#include <cstdio>
#include <vector>

#include "reference/dynamics_joint_chain.h"
#include "support/scheme_variants.h"

namespace flexarm::test {
namespace {

using History = std::vector<Vector3>;

struct Problem {
  std::string name;
  SceneBuilder scene;
  double until;          ///< [s]
  double coarsest_step;  ///< [s]
};

/// Right-angle cantilever of case D5, through loading and the first free swing. Coarse meshes are tested as well: their
/// elements rotate far, which must not affect energy corrections.
Problem right_angle_cantilever(int elements) {
  SceneBuilder b;
  b.beam("arm", {{10, 0, 0}, {10, 10, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1, 20, 10, 10}, elements,
         2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {10, 0, 0}, {0, 0, 50}, Vector3::Zero(), "0:0 1:1 2:0");
  b.probe("tip", "arm", {10, 10, 0});
  return {"right_angle_cantilever_" + std::to_string(elements), b, 3, 0.1};
}

/// Flying spaghetti of case D3. Its loads have no jumps, so that schemes with end-point loads keep their order.
Problem flying_spaghetti() {
  SceneBuilder b;
  b.beam("beam", {{-6, 8, 0}}, scene::DirectSection{1e4, 1e4, 1e4, 500, 500, 500, 1, 10, 10, 10}, 8, 2);
  b.joint("free", scene::JointKind::Floating, "world", "beam", {6, 0, 0});
  b.load("beam", {0, 0, 0}, {20, 0, 0}, {0, -100, -200}, "0:0 2.5:1 5:0");
  b.probe("tip", "beam", {-6, 8, 0});
  return {"flying_spaghetti", b, 4, 0.05};
}

/// The flexible arm, thrown in space and pushed by a follower force.
Problem arm_with_joints() {
  SceneBuilder b = flexible_arm(soft_section(), 2);
  b.load("fore", {0, 1, 0.2}, {3, 0, 2}, {0, 0.5, 0}, "1-cos(t)", scene::LoadFrame::Follower);
  initial_joint(b, "shoulder", 0.3, 1.5);
  initial_joint(b, "elbow/rx", 0.2, -1);
  initial_joint(b, "elbow/rz", -0.1, 2);
  b.probe("tip", "fore", {0, 1, 0.2});
  return {"arm_with_joints", b, 1, 0.02};
}

/// The same arm with structural damping.
Problem damped_arm(const std::string& name, double damping) {
  Problem problem = arm_with_joints();
  problem.name = name;
  for (scene::LinkDescription& link : problem.scene.scene.links)
    if (link.beam) link.beam->stiffness_proportional_damping = damping;
  return problem;
}

/// Tip positions at multiples of `coarsest_step`.
History tip_history(const Problem& problem, const IntegratorDescription& integrator, int refinement) {
  scene::SceneDescription scene = problem.scene.scene;
  scene.integrator = integrator;
  scene.integrator.step = problem.coarsest_step / refinement;
  scene.integrator.tolerance = 1e-11;
  Simulation simulation(scene);
  const int samples = static_cast<int>(std::lround(problem.until / problem.coarsest_step));
  History history;
  for (int n = 0; n < samples; ++n) {
    run(simulation, refinement);
    history.push_back(simulation.probe(0).pose.position);
  }
  return history;
}

double distance(const History& a, const History& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / a.size());
}

class OrderInTime : public ::testing::TestWithParam<std::tuple<SchemeVariant, Problem>> {};

TEST_P(OrderInTime, TipHistory) {
  const auto [variant, problem] = GetParam();
  const int order = variant.scheme.order;
  // Refinements at which each order is visible: errors are above round-off and in the asymptotic range.
  const std::vector<int> refinements =
      order == 4 ? std::vector<int>{8, 16, 32, 64} : std::vector<int>{4, 8, 16, 32, 64};
  std::vector<History> runs;
  for (const int refinement : refinements) runs.push_back(tip_history(problem, variant.integrator, refinement));
  // Richardson extrapolation from the two finest runs gives the reference. Its own error is of higher order.
  History reference = runs.back();
  const double factor = 1 / (std::pow(2.0, order) - 1);
  for (std::size_t i = 0; i < reference.size(); ++i)
    reference[i] += factor * (runs.back()[i] - runs[runs.size() - 2][i]);
  std::vector<double> error;
  for (std::size_t k = 0; k + 2 < runs.size(); ++k) error.push_back(distance(runs[k], reference));
  const double slope = std::log2(error[error.size() - 2] / error.back());
  std::printf("%s %s: errors %.2e ... %.2e %.2e, slope %.3f\n", variant.name.c_str(), problem.name.c_str(), error[0],
              error[error.size() - 2], error.back(), slope);
  EXPECT_NEAR(slope, order, 0.1 * order);
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<SchemeVariant, Problem>>& info) {
  return std::get<0>(info.param).name + "_" + std::get<1>(info.param).name;
}

INSTANTIATE_TEST_SUITE_P(Joints, OrderInTime,
                         ::testing::Combine(::testing::ValuesIn(scheme_variants()),
                                            ::testing::Values(arm_with_joints())),
                         name_of);

/// Schemes with a strong dissipation alpha. At the usual alpha, terms of first order in alpha would be hidden by other
/// terms.
std::vector<SchemeVariant> strong_hht() {
  std::vector<SchemeVariant> strong;
  for (SchemeVariant variant : scheme_variants())
    if (variant.scheme.hht != HhtForm::None) {
      variant.integrator.alpha = -0.3;
      strong.push_back({variant.name + "_strong", variant.integrator, make_scheme(variant.integrator)});
    }
  return strong;
}
INSTANTIATE_TEST_SUITE_P(StrongDissipation, OrderInTime,
                         ::testing::Combine(::testing::ValuesIn(strong_hht()), ::testing::Values(arm_with_joints())),
                         name_of);

std::vector<SchemeVariant> variants(const std::vector<std::string>& names) {
  std::vector<SchemeVariant> selected;
  for (const SchemeVariant& variant : scheme_variants())
    if (std::find(names.begin(), names.end(), variant.name) != names.end()) selected.push_back(variant);
  return selected;
}

// One relaxation time is longer than every step, the other one is shorter than most steps.
INSTANTIATE_TEST_SUITE_P(
    StructuralDamping, OrderInTime,
    ::testing::Combine(::testing::ValuesIn(variants({"em", "em0", "em_symmetric", "edmc1", "edmc2"})),
                       ::testing::Values(damped_arm("strongly_damped_arm", 0.05), damped_arm("damped_arm", 1e-3))),
    name_of);

// A backward step feeds energy into modes that the damping makes stiff. So this damping is weaker than every step.
INSTANTIATE_TEST_SUITE_P(WeakStructuralDamping, OrderInTime,
                         ::testing::Combine(::testing::ValuesIn(variants({"em4"})),
                                            ::testing::Values(damped_arm("weakly_damped_arm", 1e-4))),
                         name_of);

INSTANTIATE_TEST_SUITE_P(LargeDeformation, OrderInTime,
                         ::testing::Combine(::testing::ValuesIn(variants({"em", "em0", "m1", "newmark"})),
                                            ::testing::Values(right_angle_cantilever(2), right_angle_cantilever(4),
                                                              right_angle_cantilever(8), flying_spaghetti())),
                         name_of);

}  // namespace
}  // namespace flexarm::test
