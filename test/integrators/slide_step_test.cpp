// Compares the tangent of whole steps of sliders with differences: for each algorithm, on lines of elements and smooth
// lines, within an element and across borders.
#include "integrators/consistent_tangent.h"
#include "integrators/mechanism.h"
#include "integrators/stepper.h"

namespace flexarm {
namespace {

using namespace test;

struct SlideCase {
  const char *scheme, *slide;
  bool smooth;
  friend std::ostream& operator<<(std::ostream& out, const SlideCase& c) {
    return out << c.scheme << "_" << c.slide << (c.smooth ? "_smooth" : "");
  }
};

/// A line of six elements, on two links that are welded together. An arm with a body slides on it.
scene::SceneDescription sliding_arm(const SlideCase& c) {
  using scene::JointKind;
  SceneBuilder b;
  b.beam("line", {{1.2, 0.1, 0.2}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 3, 2);
  b.beam("rest", {{1.1, 0.1 * 1.1 / 1.2, 0.2 * 1.1 / 1.2}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 2, 3);
  b.beam("arm", {{0.1, 0.6, 0.2}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 1, 2);
  b.body("hand", 0.8, {0.1, 0, 0.2}, Matrix3::Identity() * 0.2);
  b.joint("base", JointKind::Floating, "world", "line");
  b.joint("weld", JointKind::Fixed, "line", "rest", {1.2, 0.1, 0.2});
  scene::JointDescription& run = b.joint("run", JointKind::Slide, "line", "arm", Vector3::Zero(), {0.6, 0, 0.8});
  run.slide = scene::SlideDescription{1.0, JointKind::Revolute};
  run.slide->scheme = c.slide;
  run.slide->smooth = c.smooth;
  b.joint("wrist", JointKind::Fixed, "arm", "hand", {0.1, 0.6, 0.2});
  b.scene.integrator.scheme = c.scheme;
  return b.scene;
}

class SlideStepOf : public ::testing::TestWithParam<SlideCase> {};

TEST_P(SlideStepOf, TangentIsConsistent) {
  const Model model = build_model(sliding_arm(GetParam()));
  std::size_t s = 0;
  while (model.joints[s].kind != JointMapKind::Slide) ++s;
  ASSERT_EQ(model.slide_lines[0].pieces.size(), 5u);
  RandomSource random(1);
  // The elements are 0.41 m long, then 0.55 m. From 1.0 m the slider moves within an element, over the weld, over two
  // borders, and backwards.
  for (const double travel : {0.1, 0.5, 0.95, -0.3}) {
    StepSystem system(model, *find_scheme(GetParam().scheme), BackendChoice::Matrix);
    State state = random_state(model, random, 0.1);
    state.released[s].displacement[0] = 1.0;
    system.initialise(state);
    system.begin(state, 0.2, Guess::Unchanged);
    Eigen::VectorXd update = random_update(system.degrees_of_freedom().unknowns, random, 0.1);
    const DegreesOfFreedom& dof = system.degrees_of_freedom();
    update[dof.equation[dof.first[dof.variable_of_joint(static_cast<int>(s))]]] = travel;
    system.update(update);
    ASSERT_FALSE(system.configuration().is_off_line());
    expect_consistent_tangent(system, 0.25);
  }
}

// The matrix pattern of a system follows its slider: at every place, the tangent equals that of a system that was made
// there.
class SlidePattern : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Lines, SlidePattern, ::testing::Bool());

TEST_P(SlidePattern, FollowsTheSlider) {
  const bool is_smooth = GetParam();
  SceneBuilder b;
  b.beam("line", {{4, 0, 0}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 16, 2);
  b.beam("arm", {{0.1, 0.6, 0.2}}, section(40, 20, 6, 8, 1.4, 0.2, 0.1), 1, 2);
  b.joint("base", scene::JointKind::Fixed, "world", "line");
  b.joint("run", scene::JointKind::Slide, "line", "arm").slide =
      scene::SlideDescription{0.1, scene::JointKind::Spherical};
  b.scene.joints.back().slide->smooth = is_smooth;
  const Model model = build_model(b.scene);
  std::size_t s = 0;
  while (model.joints[s].kind != JointMapKind::Slide) ++s;
  RandomSource random(2);
  State state = random_state(model, random, 0.05);
  const auto evaluate = [&](StepSystem& system, double from, double to) {
    state.released[s].displacement[0] = from;
    system.begin(state, 0.1, Guess::Unchanged);
    Eigen::VectorXd update = Eigen::VectorXd::Zero(system.degrees_of_freedom().unknowns);
    const DegreesOfFreedom& dof = system.degrees_of_freedom();
    update[dof.equation[dof.first[dof.variable_of_joint(static_cast<int>(s))]]] = to - from;
    system.update(update);
    ASSERT_TRUE(system.evaluate(true));
  };
  StepSystem walking(model, schemes().front(), BackendChoice::Matrix);
  int patterns = 0;
  for (double x = 0.1; x < 3.8; x += 0.06) {
    StepSystem fresh(model, schemes().front(), BackendChoice::Matrix);
    evaluate(walking, x, x + 0.06);
    evaluate(fresh, x, x + 0.06);
    EXPECT_EQ(dense(matrix_of(walking)), dense(matrix_of(fresh))) << x;
    // Largest number of entries, out of 208 * 208: the elements, the arm's 12 unknowns with 1 + 3 of the joint, their
    // coupling with the nodes of the active elements, and the coupling of these nodes with each other.
    const std::size_t elements = is_smooth ? 4 : 2, nodal = 6 * (2 * elements + 1);
    const std::size_t uncoupled = 18 * 18 * elements - 36 * (elements - 1);
    EXPECT_LE(matrix_of(walking).values().size(),
              16 * 18 * 18 - 15 * 36 + 16 * 16 + 2 * 16 * nodal + nodal * nodal - uncoupled);
    patterns = matrix_of(walking).pattern();
  }
  EXPECT_GE(patterns, 14);
  EXPECT_LE(patterns, 16) << "once per border";
  evaluate(walking, 3.7, 3.75);
  evaluate(walking, 0.3, 0.35);  // far away
  StepSystem fresh(model, schemes().front(), BackendChoice::Matrix);
  evaluate(fresh, 0.3, 0.35);
  EXPECT_EQ(dense(matrix_of(walking)), dense(matrix_of(fresh)));
}

std::vector<SlideCase> cases() {
  std::vector<SlideCase> out;
  for (const bool smooth : {false, true}) {
    for (const char* scheme : {"em", "m1", "m2", "std", "newmark"}) out.push_back({scheme, "sm_em", smooth});
    for (const char* slide : {"alg1", "alg3", "alg4"}) out.push_back({"m1", slide, smooth});
    out.push_back({"m2", "alg2", smooth});
    out.push_back({"std", "sme", smooth});
  }
  return out;
}
INSTANTIATE_TEST_SUITE_P(AllSchemes, SlideStepOf, ::testing::ValuesIn(cases()), ::testing::PrintToStringParamName());

}  // namespace
}  // namespace flexarm
