// Tip histories converge at second order in time to a self-converged reference.
#include <cstdio>
#include <vector>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using History = std::vector<Vector3>;

struct Problem {
  std::string name;
  SceneBuilder scene;
  double until;          ///< [s]
  double coarsest_step;  ///< [s]
};

/// Right-angle cantilever of case D5, through loading and the first free swing.
/// Coarse meshes, too: their elements turn a lot, which an energy correction must not feel.
Problem right_angle_cantilever(int elements) {
  SceneBuilder b;
  b.beam("arm", {{10, 0, 0}, {10, 10, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1, 20, 10, 10}, elements,
         2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {10, 0, 0}, {0, 0, 50}, Vector3::Zero(), "0:0 1:1 2:0");
  b.probe("tip", "arm", {10, 10, 0});
  return {"right_angle_cantilever_" + std::to_string(elements), b, 3, 0.1};
}

/// Flying spaghetti of case D3; its loads have no jumps, so that schemes with end-point loads keep their order.
Problem flying_spaghetti() {
  SceneBuilder b;
  b.beam("beam", {{-6, 8, 0}}, scene::DirectSection{1e4, 1e4, 1e4, 500, 500, 500, 1, 10, 10, 10}, 8, 2);
  b.joint("free", scene::JointKind::Floating, "world", "beam", {6, 0, 0});
  b.load("beam", {0, 0, 0}, {20, 0, 0}, {0, -100, -200}, "0:0 2.5:1 5:0");
  b.probe("tip", "beam", {-6, 8, 0});
  return {"flying_spaghetti", b, 4, 0.05};
}

/// Tip positions every `coarsest_step`.
History tip_history(const Problem& problem, const std::string& scheme, int refinement) {
  Simulation simulation(problem.scene.scene, options(scheme, problem.coarsest_step / refinement, 1e-11));
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

class SecondOrder : public ::testing::TestWithParam<std::tuple<std::string, Problem>> {};

TEST_P(SecondOrder, TipHistory) {
  const auto [scheme, problem] = GetParam();
  const int refinements[] = {4, 8, 16, 32, 64};
  std::vector<History> runs;
  for (const int refinement : refinements) runs.push_back(tip_history(problem, scheme, refinement));
  // The reference is extrapolated from the two finest runs (Richardson): its own error is of higher order.
  History reference = runs[4];
  for (std::size_t i = 0; i < reference.size(); ++i) reference[i] += (runs[4][i] - runs[3][i]) / 3;
  double error[3];
  for (int k = 0; k < 3; ++k) error[k] = distance(runs[k], reference);
  std::printf("%s %s: errors %.2e %.2e %.2e, slopes %.3f %.3f\n", scheme.c_str(), problem.name.c_str(), error[0],
              error[1], error[2], std::log2(error[0] / error[1]), std::log2(error[1] / error[2]));
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2.0, 0.2);
}
INSTANTIATE_TEST_SUITE_P(Schemes, SecondOrder,
                         ::testing::Combine(::testing::Values("em", "em0", "m1", "newmark"),
                                            ::testing::Values(right_angle_cantilever(2), right_angle_cantilever(4),
                                                              right_angle_cantilever(8), flying_spaghetti())),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param).name; });

}  // namespace
}  // namespace flexarm::test
