// Symmetry in time: N steps, all velocities reversed, N steps lead back to the start.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

/// Configuration and internal state stay, velocities change their sign (times `factor`); the predictor is forgotten.
State reversed(State state, double factor = 1) {
  for (NodeState& node : state.nodes) {
    node.velocity *= -factor;
    node.angular_velocity *= -factor;
    node.mean_spin *= -factor;
  }
  for (MassPointState& point : state.mass_points) point.angular_velocity *= -factor;
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
  double defect = 0, path = 0;  ///< distance of start and return, of start and turn
  double round_off = 0;         ///< bound of what rounding makes of the former
};

/// There and back. Each step rounds positions of size r, and thereby velocities by 2 r epsilon / h; by how much a
/// relative change of the velocities moves the end of the way back is measured by one of 1e-7. The bound is for errors
/// of all steps in one direction.
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

// Long steps of a fast motion: whatever Newton's method leaves out would show.
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

// em tests with functions of the middle of a step that goes on like the last one. That middle misses the true one by
// h^2 a / 2, from either end of the step in the same sense: what differs is of third order, and so is the return.
TEST(TimeReversal, DefectOfEmIsOfThirdOrder) {
  SceneBuilder beam = tumbling_beam();
  beam.scene.initial_links.front().angular *= 3;  // bends it so much that the defect is seen at short steps, too
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
