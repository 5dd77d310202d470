// Tests symmetry in time: after N steps, reversal of all velocities, and N more steps, the mechanism is back at the
// start.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

/// The state with reversed velocities (times `factor`) and the same configuration and internal state. The predictor is
/// reset.
State reversed(State state, double factor = 1) {
  for (NodeState& node : state.nodes) {
    node.velocity *= -factor;
    node.angular_velocity *= -factor;
    node.mean_spin *= -factor;
  }
  for (MassPointState& point : state.study.mass_points) point.angular_velocity *= -factor;
  state.history.clear();
  return state;
}

/// Largest distance of a node [m], or angle between orientations [rad].
double distance(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    largest = std::max({largest, (a.nodes[i].position - b.nodes[i].position).norm(),
                        a.nodes[i].orientation.angularDistance(b.nodes[i].orientation)});
  return largest;
}

void run_whole(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << to_string(result.reason);
    ASSERT_EQ(result.halvings, 0) << "halved steps are not taken at the same times on the way back";
  }
}

struct Return {
  double defect = 0, path = 0;  ///< distances from the start: of the returned state, and of the turning point
  double round_off = 0;         ///< bound of the defect by round-off
};

/// Runs there and back. Each step rounds positions of size r, and so velocities by 2 r epsilon / h. A change of the
/// velocities by 1e-7 measures how a relative velocity error moves the end. The bound assumes that the errors of all
/// steps have the same direction.
Return there_and_back(const SceneBuilder& scene, const std::string& scheme, double h, int steps) {
  Simulation simulation(scene.scene, options(scheme, h, 1e-10));
  const State begin = state_of(simulation);
  run_whole(simulation, steps);
  const State turn = state_of(simulation);
  Return out;
  out.path = distance(begin, turn);
  restore(simulation, reversed(turn));
  run_whole(simulation, steps);
  const State back = state_of(simulation);
  out.defect = distance(begin, back);
  restore(simulation, reversed(turn, 1 + 1e-7));
  run_whole(simulation, steps);
  const double growth = distance(state_of(simulation), back) / 1e-7;
  double extent = 0;
  for (const NodeState& node : turn.nodes) extent = std::max(extent, node.position.norm());
  const double speed = std::sqrt(2 * simulation.energies().kinetic / total_mass(simulation));
  out.round_off = 2 * steps * (2 * extent * kEpsilon / h / speed) * growth;
  return out;
}

void expect_return(const SceneBuilder& scene, const std::string& scheme, double h, int steps) {
  const Return way = there_and_back(scene, scheme, h, steps);
  std::printf("%s: back within %.1e after a way of %.1e; bound of round-off %.1e\n", scheme.c_str(), way.defect,
              way.path, way.round_off);
  EXPECT_GT(way.path, 0.5) << "it must move";
  EXPECT_LT(way.defect, way.round_off);
}

class TimeReversal : public ::testing::TestWithParam<std::tuple<std::string, scene::JointKind>> {};

TEST_P(TimeReversal, LeadsBackToTheStart) {
  const auto [scheme, kind] = GetParam();
  expect_return(free_tree(kind), scheme, 0.02, 150);
}

// Long steps of a fast motion: any error of Newton's method would be visible.
TEST_P(TimeReversal, LeadsBackToTheStartInLongSteps) {
  const auto [scheme, kind] = GetParam();
  SceneBuilder tree = free_tree(kind);
  tree.scene.initial_links.front().angular *= 2;
  expect_return(tree, scheme, 0.04, 24);
}
INSTANTIATE_TEST_SUITE_P(Schemes, TimeReversal,
                         ::testing::Combine(::testing::Values("em_symmetric", "em4"),
                                            ::testing::Values(scene::JointKind::Fixed, scene::JointKind::Revolute,
                                                              scene::JointKind::Spherical,
                                                              scene::JointKind::Universal)));

// The test functions of em belong to a predicted middle of the step, which continues the last step. This middle differs
// from the true one by h^2 a / 2, in the same sense from either end of the step. So the difference, and the error of
// the return, are of third order.
TEST(TimeReversal, DefectOfEmIsOfThirdOrder) {
  SceneBuilder beam = tumbling_beam();
  beam.scene.initial_links.front().angular *= 3;  // bends it so much that the defect is visible at short steps, too
  std::vector<double> defects;
  for (const int refinement : {1, 2, 4, 8}) {
    const Return way = there_and_back(beam, "em", 0.04 / refinement, 48 * refinement);
    std::printf("em, h = %.4f: back within %.2e (bound of round-off %.0e)", 0.04 / refinement, way.defect,
                way.round_off);
    if (!defects.empty()) std::printf(", slope %.2f", std::log2(defects.back() / way.defect));
    std::printf("\n");
    EXPECT_GT(way.defect, way.round_off) << "not symmetric";
    defects.push_back(way.defect);
  }
  EXPECT_NEAR(std::log2(defects[2] / defects[3]), 3, 0.3);
}

}  // namespace
}  // namespace flexarm::test
