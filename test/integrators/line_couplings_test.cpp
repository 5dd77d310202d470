// Tests lines over many nodes, whose tangents consist of pieces: elimination along the tree against the matrix.
#include <algorithm>
#include <cmath>

#include "integrators/scheme_step.h"
#include "support/dense_solution.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// A clamped beam with a disc on it, a second beam on a hinge, a tool with a drum, and a rod beside them.
constexpr const char* kArm = R"(<link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="upper"/> </joint>
  <link name="upper"> <beam elements="4" order="2"> <centerline> <line to="1 0 0"/> </centerline>
    <section ea="2e4" ga2="1e4" ga3="1e4" gj="200" ei2="250" ei3="220" mass="0.5" j1="0.02" j2="0.01" j3="0.01"/> </beam> </link>
  <joint name="elbow" type="continuous"> <parent link="upper"/> <child link="lower"/> <origin xyz="1 0 0"/>
    <axis xyz="0 1 0"/> </joint>
  <link name="lower"> <beam elements="3" order="1"> <centerline> <line to="0.6 0 0"/> </centerline>
    <section ea="2e4" ga2="1e4" ga3="1e4" gj="200" ei2="250" ei3="220" mass="0.5" j1="0.02" j2="0.01" j3="0.01"/> </beam> </link>
  <joint name="glue" type="fixed"> <parent link="upper"/> <child link="disc"/> <origin xyz="0.5 0 0"/> </joint>
  <link name="disc"> <inertial> <mass value="0.2"/> <inertia ixx="0.02" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial> </link>
  <joint name="wrist" type="continuous"> <parent link="lower"/> <child link="tool"/> <origin xyz="0.6 0 0"/>
    <axis xyz="0 0 1"/> </joint>
  <link name="tool"> <inertial> <mass value="0.4"/> <inertia ixx="0.02" iyy="0.01" izz="0.03" ixy="0" ixz="0" iyz="0"/>
    </inertial> </link>
  <joint name="axle" type="continuous"> <parent link="tool"/> <child link="drum"/> <origin xyz="0.2 0 0"/>
    <axis xyz="0 1 0"/> </joint>
  <link name="drum"> <inertial> <mass value="0.3"/> <inertia ixx="0.02" iyy="0.01" izz="0.03" ixy="0" ixz="0" iyz="0"/>
    </inertial> </link>
  <joint name="foot" type="floating"> <parent link="world"/> <child link="rod"/> <origin xyz="0.1 0 -0.5"/> </joint>
  <link name="rod"> <beam elements="2" order="2"> <centerline> <line to="0.4 0 0.2"/> </centerline>
    <section ea="2e4" ga2="1e4" ga3="1e4" gj="200" ei2="250" ei3="220" mass="0.5" j1="0.02" j2="0.01" j3="0.01"/> </beam> </link>)";

constexpr const char* kAlongTheArm = R"(<via link="world" at="-0.1 0 0.05"/>
    <vias link="upper" from="0 0 0.05" to="1 0 0.05" count="5"/> <via link="disc" at="0 0.1 0.06"/>
    <vias link="lower" from="0.2 0 0.04" to="0.6 0 0.04" count="3"/>)";

/// Returns the model of a scene in which so many tendons should have pieces.
Model model_with(const std::string& text, int in_pieces) {
  Model model = build_model(scene_of(text));
  int count = 0;
  for (const auto& element : model.force_elements) count += element->pieces().pairs.empty() ? 0 : 1;
  EXPECT_EQ(count, in_pieces) << text;
  return model;
}

Model arm_with(const std::string& tendons, int in_pieces) {
  return model_with(std::string(R"(<robot name="arm">)") + kArm + tendons + "</robot>", in_pieces);
}

std::string line(const std::string& attributes, const std::string& guides) {
  return "<tendon name=\"line\" " + attributes + ">" + guides + "</tendon>";
}

std::vector<Model> models_with_lines() {
  const std::string along = kAlongTheArm, to_tool = along + R"(<via link="tool" at="0.1 0 0.05"/>)";
  const std::string pulley =
      R"(<pulley link="tool" at="0.1 0 -0.02" axis="0 1 0" radius="0.05" side="left" wrap="0.4"/>)";
  const std::string drum = R"(<pulley link="drum" axis="0 1 0" radius="0.04" side="left" grips="true"/>)";
  const std::string law = R"(ea="900" damping="3" rest_length="1.3")";
  const std::string other = R"(<tendon tension="30"> <vias link="upper" from="0.25 0 -0.05" to="1 0 -0.05" count="4"/>
    <via link="tool" at="0 0 -0.1"/> </tendon>)";
  const std::string across =
      R"(<tendon ea="500" rest_length="1"> <vias link="rod" from="0 0.02 0" to="0.4 0.02 0.2" count="3"/>
    <via link="disc" at="0 0 -0.1"/> <via link="tool" at="0.05 0 0"/> <via link="world" at="1 0 -1"/> </tendon>)";
  const std::string loop = R"(<loop_joint name="closing" type="spherical"> <parent link="upper"/> <child link="rod"/>
    <origin xyz="0.5 0 -0.3"/> <child_origin xyz="0.4 0 0.2"/> </loop_joint>)";
  const std::string slider = R"(<link name="rider"> <inertial> <mass value="0.3"/>
      <inertia ixx="0.02" iyy="0.01" izz="0.03" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <joint name="slide" type="floating"> <parent link="upper"/> <child link="rider"/> <slide start="0.6"/> </joint>
    <tendon ea="700" rest_length="0.8"> <vias link="upper" from="0.25 0 -0.05" to="1 0 -0.05" count="4"/>
      <via link="rider" at="0 0.1 0.1"/> <via link="tool" at="0 0 -0.1"/> </tendon>)";
  const std::string reel = R"(<winch name="hoist" tendon="line"> <drive rotor_inertia="3"/> </winch>)";
  std::vector<Model> models;
  models.push_back(arm_with(line(law, to_tool), 1));
  models.push_back(arm_with(line(law, to_tool) + other + across, 3));
  models.push_back(arm_with(line(law, to_tool) + across + loop, 2));
  models.push_back(arm_with(line(law, to_tool) + reel, 1));
  models.push_back(arm_with(line(law, to_tool) + slider, 2));
  models.push_back(arm_with(line(law, along + pulley + drum), 1));
  models.push_back(arm_with(line(law, along + pulley + drum) + reel + across + other, 3));
  // With friction, each part has auxiliary variables of its own. The one between points of the world has no nodes.
  const std::string rubbing =
      R"(<via link="world" at="-0.1 0 0.05"/> <via link="world" at="-0.05 0.02 0.05" friction="0.1"/>
    <via link="world" at="-0.02 0 0.05" friction="0.2"/> <vias link="upper" from="0 0 0.05" to="0.5 0 0.05" count="3" friction="0.05"/>
    <via link="upper" at="0.75 0 0.05"/> <via link="upper" at="1 0 0.05" friction="0.02"/> <via link="disc" at="0 0.1 0.06"/>
    <vias link="lower" from="0.2 0 0.04" to="0.6 0 0.04" count="3" friction="0.03"/>)";
  const std::string gripping =
      R"(<pulley link="tool" at="0.1 0 -0.02" axis="0 1 0" radius="0.05" side="left" grips="true"/>)";
  models.push_back(arm_with(line(law, rubbing + R"(<via link="tool" at="0.1 0 0.05"/>)"), 1));
  models.push_back(arm_with(line(law, rubbing + gripping + drum) + reel + across + other, 3));
  models.push_back(arm_with(line(law, along + gripping + drum) + loop, 1));
  return models;
}

/// Compares solutions of both systems, with new and with kept factors, in steps of the whole tangent.
void expect_solutions_of_the_matrix(StepSystem& matrix, StepSystem& tree) {
  ASSERT_TRUE(matrix.evaluate(true));
  ASSERT_TRUE(tree.evaluate(true));
  EXPECT_EQ(matrix.residual(), tree.residual());
  const Eigen::MatrixXd tangent = dense(matrix_of(matrix));
  for (const bool is_new : {true, false}) {
    const Eigen::VectorXd b = is_new ? matrix.residual() : Eigen::VectorXd::Ones(tangent.cols());
    Eigen::VectorXd x = b, reference = b;
    ASSERT_TRUE(is_new ? tree.tangent().factorise_and_solve(x) : tree.tangent().solve(x));
    ASSERT_TRUE(is_new ? matrix.tangent().factorise_and_solve(reference) : matrix.tangent().solve(reference));
    // As in tree_tangent_test: round-off of thousands of operations, on fronts without pivoting between fronts.
    EXPECT_LE((tangent * x - b).norm(), 1e-12 * (tangent.norm() * x.norm() + b.norm()));
    EXPECT_LE((x - reference).norm(), 1e-7 * reference.norm());
  }
}

std::vector<SchemeVariant> without_interpolated_forces(std::vector<SchemeVariant> variants) {
  variants.erase(std::remove_if(variants.begin(), variants.end(),
                                [](const SchemeVariant& variant) { return variant.scheme.hht != HhtForm::None; }),
                 variants.end());
  return variants;
}

bool suits_backward_steps(const Model& model) {
  return std::all_of(model.force_elements.begin(), model.force_elements.end(),
                     [](const auto& element) { return element->suits_backward_steps(); });
}

class LineCouplings : public SchemeStep {};
class LineCouplingsTangent : public SchemeStep {};

TEST_P(LineCouplings, AreSolvedLikeByTheMatrix) {
  for (const Model& model : models_with_lines()) {
    if (scheme().is_composition && !suits_backward_steps(model)) continue;
    StepSystem matrix(model, scheme(), BackendChoice::Matrix), tree(model, scheme());
    RandomSource random(5);
    const State state = prepared(random_state(model, random, 0.05), matrix, random);
    for (StepSystem* system : {&matrix, &tree}) system->begin(state, 0.01, Guess::Unchanged);
    for (int repeat = 0; repeat < 2; ++repeat) {
      const Eigen::VectorXd update = random_update(matrix.degrees_of_freedom().unknowns, random, 0.01);
      for (StepSystem* system : {&matrix, &tree}) system->update(update);
      expect_solutions_of_the_matrix(matrix, tree);
    }
  }
}

// The matrix gets the tangents of lines in pieces, too.
TEST_P(LineCouplingsTangent, IsThatOfTheResidual) {
  const std::vector<Model> models = models_with_lines();
  expect_consistent_tangent_of_a_slow_step(models[1], 5);
  expect_consistent_tangent_of_a_slow_step(models[5], 6);
}

INSTANTIATE_TEST_SUITE_P(Schemes, LineCouplings, ::testing::ValuesIn(without_interpolated_forces(scheme_variants(0.2))),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Schemes, LineCouplingsTangent,
                         ::testing::ValuesIn(without_interpolated_forces(with_consistent_tangent())),
                         [](const auto& info) { return info.param.name; });

// A boom on a hinge, held by a line along a mast. In statics nothing else holds the hinge: without the product of low
// rank its pivot is that of the line's tension, which is zero or as small as the stretch. A boom of many elements is
// eliminated before the mast, so that its hinge waits for the auxiliary variable.
TEST(LineCouplingsInStatics, HoldWhatNothingElseHolds) {
  const std::string section =
      R"(<section ea="2e7" ga2="1e7" ga3="1e7" gj="2e5" ei2="2e5" ei3="2e5" mass="0.5" j1="0.02" j2="0.01" j3="0.01"/>)";
  const double length = 1.6 + std::sqrt(8);  // of the line
  for (const int elements : {1, 9})
    for (const double stretch : {-1e-3, 1e-9, 1e-3}) {
      const std::string text = fmt::format(
          R"(<robot name="crane"> <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="mast"/> </joint>
  <link name="mast"> <beam elements="5" order="1"> <centerline> <line to="0 0 2"/> </centerline> <orientation y="0 1 0"/>
    {0} </beam> </link>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 1 0"/> </joint>
  <link name="boom"> <beam elements="{1}" order="1"> <centerline> <line to="2 0 0"/> </centerline> {0} </beam> </link>
  <tendon ea="2e5" rest_length="{2:.17g}"> <vias link="mast" from="0 0 0.4" to="0 0 2" count="5"/>
    <via link="boom" at="2 0 0"/> </tendon> </robot>)",
          section, elements, length * (1 - stretch));
      const Model model = model_with(text, 1);
      const Scheme statics = statics_of(schemes().front());
      StepSystem matrix(model, statics, BackendChoice::Matrix), tree(model, statics);
      const State state = initial_state(model);
      for (StepSystem* system : {&matrix, &tree}) {
        system->begin_equilibrium(state, 1);
        ASSERT_TRUE(system->evaluate(true));
      }
      const bool is_taut = stretch > 0;
      EXPECT_EQ(is_invertible(dense(matrix_of(matrix))), is_taut);
      if (is_taut) expect_solutions_of_the_matrix(matrix, tree);
    }
}

}  // namespace
}  // namespace flexarm::test
