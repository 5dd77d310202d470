// Compares elimination along the tree with the assembled matrix, for whole steps of every scheme.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "flexarm/scene/urdf_reader.h"
#include "integrators/scheme_step.h"
#include "integrators/stepper.h"
#include "solver/tree_tangent.h"
#include "support/dense_solution.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

using namespace test;

Model rubbing(Model model) {
  for (Coordinate& coordinate : model.coordinates) {
    coordinate.sticks = true;
    coordinate.friction_coefficient = coordinate.is_angle ? 0 : 0.4;
  }
  return model;
}

/// Bound of |A x - b| over |A| |x| + |b| after an elimination: thousands of operations, on fronts without pivoting
/// between fronts.
constexpr double kBackwardError = 1e-12;

/// Size of random displacements of a scene. In scenes with contact they are small against the depth by which contacts
/// give way.
double displacement_of(const Model& model) {
  const bool touches = std::any_of(model.force_elements.begin(), model.force_elements.end(),
                                   [](const auto& element) { return element->hits(); });
  return touches ? 1e-5 : 1e-3;
}

void expect_equal_solutions(StepSystem& matrix, StepSystem& tree) {
  ASSERT_TRUE(matrix.evaluate(true));
  ASSERT_TRUE(tree.evaluate(true));
  EXPECT_EQ(matrix.residual(), tree.residual());
  const Eigen::MatrixXd tangent = dense(matrix_of(matrix));
  for (int repeat = 0; repeat < 3; ++repeat) {  // with new factors, then with kept ones
    const Eigen::VectorXd b = repeat < 2 ? matrix.residual() : Eigen::VectorXd::Ones(tangent.cols());
    Eigen::VectorXd x = b;
    ASSERT_TRUE(repeat == 0 ? tree.tangent().factorise_and_solve(x) : tree.tangent().solve(x));
    EXPECT_LE((tangent * x - b).norm(), kBackwardError * (tangent.norm() * x.norm() + b.norm()));
  }
}

class TreeSystem : public SchemeStep {
 protected:
  /// Compares both systems at the same random trial configuration. Every other coordinate with dry friction sticks.
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
  for (const bool floating : {false, true}) expect_equal_solutions_of_a_step(build_model(every_joint_scene(floating)));
}

// Friction holds joints, so that their rows are replaced.
TEST_P(TreeSystem, SolvesWhereFrictionHolds) {
  if (scheme().is_composition) GTEST_SKIP() << "its step backwards refuses friction that sticks";
  expect_equal_solutions_of_a_step(rubbing(build_model(every_joint_scene(false))));
}

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_path("config")))
    if (entry.path().extension() == ".urdf") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Model model_of(const std::string& file) {
  return build_model(*scene::read_scene_file(file).scene);
}

// Each scene is solved at two places of its sliders, so that data of the first place must be replaced at the second.
TEST_P(TreeSystem, SolvesWithTheTangentsOfAllScenes) {
  for (const std::string& file : scene_files()) {
    SCOPED_TRACE(file);
    const Model model = model_of(file);
    std::optional<StepSystem> matrix, tree;
    try {
      matrix.emplace(model, scheme(), BackendChoice::Matrix);
      tree.emplace(model, scheme());
    } catch (const ModelError&) {
      continue;  // dry friction in a backward sub-step
    }
    RandomSource random(2);
    const double size = displacement_of(model);
    const State state = prepared(random_state(model, random, size), *matrix, random);
    for (StepSystem* system : {&*matrix, &*tree}) system->begin(state, 1e-3, Guess::Unchanged);
    for (const double times : {1, 3}) {
      const Eigen::VectorXd update = random_update(matrix->degrees_of_freedom().unknowns, random, times * size);
      for (StepSystem* system : {&*matrix, &*tree}) system->update(update);
      expect_equal_solutions(*matrix, *tree);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, TreeSystem, ::testing::ValuesIn(scheme_variants(0.2)),
                         [](const auto& info) { return info.param.name; });

// Statics has no inertia to make the tangent regular, and has forces that stiffen. Joints that nothing holds make the
// tangent singular.
TEST(TreeTangent, SolvesWithTheTangentOfStatics) {
  const Scheme statics = statics_of(schemes().front());
  int regular = 0;
  for (const std::string& file : scene_files()) {
    SCOPED_TRACE(file);
    const Model model = model_of(file);
    StepSystem matrix(model, statics, BackendChoice::Matrix), tree(model, statics);
    const State state = initial_state(model);
    RandomSource random(3);
    const Eigen::VectorXd update = random_update(matrix.degrees_of_freedom().unknowns, random, displacement_of(model));
    for (StepSystem* system : {&matrix, &tree}) {
      system->begin_equilibrium(state, 0.7);
      system->update(update);
    }
    ASSERT_TRUE(matrix.evaluate(true));
    ASSERT_TRUE(tree.evaluate(true));
    if (!is_invertible(dense(matrix_of(matrix)))) continue;
    expect_equal_solutions(matrix, tree);
    ++regular;
  }
  EXPECT_GT(regular, 0);
}

// A nut on a screw without load: the pivots are zero up to round-off.
TEST(TreeTangent, ReportsWhatNothingHolds) {
  const Model model = model_of(source_path("config/thesis/12_1_screw_node_to_element.urdf"));
  StepSystem system(model, statics_of(schemes().front()));
  const State state = initial_state(model);
  system.begin_equilibrium(state, 1);
  ASSERT_TRUE(system.evaluate(true));
  EXPECT_FALSE(system.tangent().factorise());
}

TEST(TreeTangent, SuitsEveryJoint) {
  for (const bool floating : {false, true}) {
    const Model model = build_model(every_joint_scene(floating));
    EXPECT_TRUE(TreeTangent::suits(model, DegreesOfFreedom(model)));
  }
}

}  // namespace
}  // namespace flexarm
