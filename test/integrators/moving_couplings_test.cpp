// Tests force elements that act on other nodes in each step, so that the couplings in the tangent change.
#include <algorithm>

#include "elements/line_element.h"
#include "integrators/scheme_step.h"
#include "integrators/stepper.h"
#include "support/allocations.h"

namespace flexarm::test {
namespace {

/// A spring of zero rest length. It acts between one node and the nearest of the other nodes at the beginning of the
/// step.
class NearestSpring : public ForceElement {
 public:
  NearestSpring(int node, const std::vector<int>& others)
      : ForceElement("", with(node, others)), visited_(others.size() + 1) {}

  const char* kind() const override { return "nearest_spring"; }
  std::string description() const override { return ""; }
  int most_nodes() const override { return 2; }
  int find_nodes(const ForceStart& start, int* nodes) const override {
    const std::vector<NodePose>& poses = start.poses;
    const auto distance = [&](int other) { return (poses[other].position - poses[reach()[0]].position).norm(); };
    nodes[0] = reach()[0];
    nodes[1] =
        *std::min_element(reach().begin() + 1, reach().end(), [&](int a, int b) { return distance(a) < distance(b); });
    visited_.at(nodes[1]) = true;
    return 2;
  }
  void evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const override {
    const double weight = step.at_end ? 1 : 0.5;
    const auto distance = [&](const std::vector<NodePose>& poses) {
      return Vector3(poses[nodes[0]].position - poses[nodes[1]].position);
    };
    const Vector3 force = kStiffness * ((1 - weight) * distance(step.begin) + weight * distance(step.end));
    action.residual << force, Vector3::Zero(), -force, Vector3::Zero();
    if (action.tangent.size() == 0) return;
    action.tangent.setZero();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        action.tangent.block<3, 3>(6 * i, 6 * j).diagonal().setConstant((i == j ? 1 : -1) * weight * kStiffness);
  }
  double energy(const State&, const double*) const override { return 0; }  // not needed in these tests
  ForceMeasures measures(const State&, const double*, const int*) const override { return {}; }
  DamperTensions dampers(const State&, const double*, const Eigen::VectorXd&) const override { return {}; }

  /// Number of other nodes on which the spring has acted since the last forget().
  long visits() const { return std::count(visited_.begin(), visited_.end(), true); }
  void forget() { std::fill(visited_.begin(), visited_.end(), false); }

 private:
  mutable std::vector<char> visited_;  // per node
  static constexpr double kStiffness = 30;
  static std::vector<int> with(int node, const std::vector<int>& others) {
    std::vector<int> all = {node};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }
};

/// An arm of two beams and a body that flies past them.
Model arm_and_body(std::shared_ptr<NearestSpring>& spring) {
  SceneBuilder b;
  b.beam("upper", {{0.5, 0, 0}}, section(2e4, 1e4, 200, 250, 0.5, 0.02, 0.01), 3, 2);
  b.joint("hinge", scene::JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.beam("lower", {{0.5, 0, 0}}, section(2e4, 1e4, 200, 250, 0.5, 0.02, 0.01), 2, 1);
  b.joint("elbow", scene::JointKind::Spherical, "upper", "lower", {0.5, 0, 0});
  b.body("tool", 0.3, {0.02, 0, 0.01}, Vector3(0.001, 0.002, 0.0015).asDiagonal());
  b.joint("wrist", scene::JointKind::Revolute, "lower", "tool", {0.5, 0, 0}, {0, 0, 1});
  b.body("ball", 0.7, Vector3::Zero(), Vector3(0.01, 0.02, 0.015).asDiagonal());
  b.joint("flight", scene::JointKind::Floating, "world", "ball", {-0.1, 0.1, 0.1});
  b.scene.initial_joints = {{"flight/x", 0, 5, {}}, {"wrist", 0, 3, {}}};
  Model model = build_model(b.scene);
  std::vector<int> others;
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i)
    if (i != model.links.back().frame.node) others.push_back(i);
  spring = std::make_shared<NearestSpring>(model.links.back().frame.node, others);
  model.force_elements.push_back(spring);
  return model;
}

class MovingCouplings : public SchemeStep {};
class MovingCouplingsTangent : public SchemeStep {};

/// The schemes that support force elements, i.e. those that do not interpolate forces in time.
std::vector<SchemeVariant> with_force_elements(std::vector<SchemeVariant> variants) {
  variants.erase(std::remove_if(variants.begin(), variants.end(),
                                [](const SchemeVariant& variant) { return variant.scheme.hht != HhtForm::None; }),
                 variants.end());
  return variants;
}

// In every step, wherever the spring acts, elimination along the tree gives the same residual and solution as the
// matrix.
TEST_P(MovingCouplings, AreSolvedLikeByTheMatrix) {
  std::shared_ptr<NearestSpring> spring;
  const Model model = arm_and_body(spring);
  StepSystem matrix(model, scheme(), BackendChoice::Matrix), tree(model, scheme());
  RandomSource random(3);
  State state = initial_state(model);
  tree.initialise(state);
  spring->forget();
  for (int n = 0; n < 12; ++n) {
    const Eigen::VectorXd update = random_update(tree.degrees_of_freedom().unknowns, random, 0.02);
    state.nodes[spring->reach()[0]].position.x() = -0.1 + 0.1 * n;
    state.released.back().displacement.x() = -0.1 + 0.1 * n;
    Eigen::VectorXd solutions[2];
    for (StepSystem* system : {&matrix, &tree}) {
      system->begin(state, 0.01, Guess::Unchanged);
      system->update(update);
      ASSERT_TRUE(system->evaluate(true));
      solutions[system == &tree] = system->residual();
      ASSERT_TRUE(system->tangent().factorise_and_solve(solutions[system == &tree]));
    }
    EXPECT_EQ(matrix.residual(), tree.residual());
    const Eigen::MatrixXd tangent = dense(matrix_of(matrix));
    EXPECT_LE((tangent * solutions[1] - tree.residual()).norm(),
              1e-12 * (tangent.norm() * solutions[1].norm() + tree.residual().norm()));
    EXPECT_LE((solutions[1] - solutions[0]).norm(), 1e-7 * solutions[0].norm());
  }
  EXPECT_GE(spring->visits(), 4);
}

TEST_P(MovingCouplingsTangent, IsThatOfTheResidual) {
  std::shared_ptr<NearestSpring> spring;
  const Model model = arm_and_body(spring);
  expect_consistent_tangent_of_a_slow_step(model, 5);
}

INSTANTIATE_TEST_SUITE_P(Schemes, MovingCouplings, ::testing::ValuesIn(with_force_elements(scheme_variants(0.2))),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Schemes, MovingCouplingsTangent,
                         ::testing::ValuesIn(with_force_elements(with_consistent_tangent())),
                         [](const auto& info) { return info.param.name; });

// A whole run with elimination along the tree: the spring moves from node to node, and nothing is allocated.
TEST(MovingCouplingsInARun, AllocateNothing) {
  std::shared_ptr<NearestSpring> spring;
  const Model model = arm_and_body(spring);
  StepSettings settings;
  settings.step = 2e-3;
  const Scheme scheme = *find_scheme("em");
  Stepper stepper(model, scheme, settings);
  State state = initial_state(model);
  stepper.initialise(state);
  ASSERT_TRUE(stepper.advance(state).converged);
  spring->forget();
  bool is_good = true;
  const long count = allocations_in([&] {
    for (int n = 0; n < 120; ++n) is_good = stepper.advance(state).converged && is_good;
  });
  EXPECT_TRUE(is_good);
  EXPECT_GE(spring->visits(), 4);
  if (kCountsAllocations) {
    EXPECT_EQ(count, 0);
  }
}

}  // namespace
}  // namespace flexarm::test
