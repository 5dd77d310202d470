// The elimination along the tree against the assembled matrix, for whole steps of every scheme.
#include <Eigen/Dense>

#include "flexarm/scene/urdf_reader.h"
#include "integrators/scheme_step.h"
#include "integrators/stepper.h"
#include "solver/tree_tangent.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

using namespace test;

/// Every joint that leaves the mechanism a tree: no loops, no slides, no coordinates that follow others.
scene::SceneDescription tree_scene(bool floating) {
  scene::SceneDescription scene = every_joint_scene(floating);
  scene.loop_joints.clear();
  for (scene::JointDescription& joint : scene.joints) {
    joint.mimic.reset();
    if (joint.kind != scene::JointKind::Slide) continue;
    joint.kind = scene::JointKind::Prismatic;
    joint.slide.reset();
    joint.profile.reset();
  }
  return scene;
}

Model rubbing(Model model) {
  for (Coordinate& coordinate : model.coordinates) {
    coordinate.sticks = true;
    coordinate.friction_coefficient = coordinate.is_angle ? 0 : 0.4;
  }
  return model;
}

/// |A x - b| over |A| |x| + |b| after an elimination; thousands of operations on fronts that are not pivoted against
/// each other.
constexpr double kBackwardError = 1e-12;

void expect_equal_solutions(StepSystem& matrix, StepSystem& tree) {
  ASSERT_TRUE(matrix.evaluate(true));
  ASSERT_TRUE(tree.evaluate(true));
  EXPECT_EQ(matrix.residual(), tree.residual());
  const Eigen::MatrixXd tangent = dense(matrix_of(matrix));
  ASSERT_TRUE(tree.tangent().factorise());
  for (int repeat = 0; repeat < 2; ++repeat) {
    const Eigen::VectorXd b = repeat == 0 ? matrix.residual() : Eigen::VectorXd::Ones(tangent.cols());
    Eigen::VectorXd x = b;
    ASSERT_TRUE(tree.tangent().solve(x));
    EXPECT_LE((tangent * x - b).norm(), kBackwardError * (tangent.norm() * x.norm() + b.norm()));
  }
}

class TreeSystem : public SchemeStep {
 protected:
  /// Both systems at the same random trial; every other coordinate with dry friction rests.
  void expect_equal_solutions_of_a_step(const Model& model) const {
    StepSystem matrix(model, scheme(), BackendChoice::Matrix), tree(model, scheme());
    RandomSource random(1);
    State state = prepared(random_state(model, random, 0.15), matrix, random);
    for (std::size_t i = 0; i < state.rests.size(); ++i) state.rests[i] = i % 2;
    const Eigen::VectorXd update = random_update(matrix.degrees_of_freedom().unknowns, random, 0.05);
    for (StepSystem* system : {&matrix, &tree}) {
      system->begin(state, 0.2, Guess::Unchanged);
      system->update(update);
    }
    expect_equal_solutions(matrix, tree);
  }
};

TEST_P(TreeSystem, SolvesWithTheTangentOfAStep) {
  for (const bool floating : {false, true}) expect_equal_solutions_of_a_step(build_model(tree_scene(floating)));
}

// Joints that friction holds: their rows are replaced.
TEST_P(TreeSystem, SolvesWhereFrictionHolds) {
  if (scheme().is_composition) GTEST_SKIP() << "its step backwards refuses friction that sticks";
  expect_equal_solutions_of_a_step(rubbing(build_model(tree_scene(false))));
}

INSTANTIATE_TEST_SUITE_P(Schemes, TreeSystem, ::testing::ValuesIn(scheme_variants(0.2)),
                         [](const auto& info) { return info.param.name; });

scene::SceneDescription example(const std::string& name) {
  return *scene::read_scene_file(source_path("config/examples/" + name + ".urdf")).scene;
}

// Without inertia, which helps dynamics, and with forces that stiffen.
TEST(TreeTangent, SolvesWithTheTangentOfStatics) {
  for (const char* name : {"cantilever", "curved_and_twisted"}) {
    const Model model = build_model(example(name));
    const Scheme statics = statics_of(schemes().front());
    StepSystem matrix(model, statics, BackendChoice::Matrix), tree(model, statics);
    const State state = initial_state(model);
    RandomSource random(3);
    const Eigen::VectorXd update = random_update(matrix.degrees_of_freedom().unknowns, random, 0.05);
    for (StepSystem* system : {&matrix, &tree}) {
      system->begin_equilibrium(state, 0.7);
      system->update(update);
    }
    expect_equal_solutions(matrix, tree);
  }
}

TEST(TreeTangent, SuitsTreesOnly) {
  const auto suits = [](const scene::SceneDescription& scene) {
    const Model model = build_model(scene);
    return TreeTangent::suits(model, DegreesOfFreedom(model));
  };
  EXPECT_TRUE(suits(tree_scene(false)));
  EXPECT_TRUE(suits(example("cantilever")));
  EXPECT_TRUE(suits(example("rigid_double_pendulum")));
  EXPECT_FALSE(suits(example("sliding_arm"))) << "a slider couples all nodes of its line";
  EXPECT_FALSE(suits(example("four_bar"))) << "a loop";
  scene::SceneDescription following = tree_scene(false);
  following.joints.back().mimic = scene::Mimic{"shoulder", 0.7, 0.1};
  following.joints.back().kind = scene::JointKind::Revolute;
  EXPECT_FALSE(suits(following)) << "a coordinate follows another";
}

}  // namespace
}  // namespace flexarm
