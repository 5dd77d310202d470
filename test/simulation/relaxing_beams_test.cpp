// Tests what simulations keep of beams with Maxwell elements: in copies, checkpoints, failed steps, payloads, and
// derivatives of runs.
#include <cmath>

#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/linear_model.h"
#include "flexarm/simulation/payloads.h"
#include "simulation/same_bits.h"
#include "simulation/sensitivity_scenes.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Two relaxing beams, which swing in space: the one with one Maxwell element hangs on the one with two, or on the
/// world.
SceneBuilder relaxing_arm(const std::string& parent = "upper") {
  SceneBuilder b;
  b.scene.integrator.step = 5e-3;
  b.scene.gravity = {0, 0, -9.81};
  const scene::DirectSection section{2e4, 1e4, 1e4, 20, 25, 25, 0.5, 2e-3, 1e-3, 1e-3};
  b.beam("upper", {{0.6, 0, 0}}, section, 3, 2).maxwell = {{0.4, 0.02}, {0.1, 0.5}};
  b.beam("lower", {{0.5, 0, 0}}, section, 2, 2).maxwell = {{0.3, 0.1}};
  b.joint("shoulder", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, parent, "lower", {0.6, 0, 0}, {0.6, 0, 0.8});
  b.probe("tip", "lower", {0.5, 0, 0});
  return b;
}

void take_steps(Simulation& simulation, int steps) {
  for (int n = 0; n < steps; ++n) ASSERT_TRUE(simulation.step().converged) << "step " << n;
}

TEST(RelaxingBeams, ContinueFromSnapshotsCopiesAndCheckpoints) {
  const SimulationOptions options = full_newton();  // with it, only to within Newton's tolerance
  Simulation whole(relaxing_arm().scene, options);
  take_steps(whole, 20);
  const Snapshot snapshot = whole.snapshot();
  Simulation copied = whole.copy(), resumed(relaxing_arm().scene, options);
  read_checkpoint_text(resumed, checkpoint_text(whole), "checkpoint");
  take_steps(whole, 20);
  const State expected = state_of(whole);
  for (Simulation* other : {&copied, &resumed}) {
    take_steps(*other, 20);
    EXPECT_TRUE(same_bits(state_of(*other), expected));
  }
  whole.restore(snapshot);
  take_steps(whole, 20);
  EXPECT_TRUE(same_bits(state_of(whole), expected));
}

TEST(RelaxingBeams, SetJointStateMovesStrainsAlong) {
  Simulation simulation(relaxing_arm().scene);
  take_steps(simulation, 20);
  const auto before = state_of(simulation).branch_strains;
  simulation.set_joint_state({{*simulation.find_coordinate("shoulder"), 1.0, 0.0}});
  EXPECT_EQ(state_of(simulation).branch_strains, before);
}

// Without the beam that has two Maxwell elements, the model has one for each point.
TEST(RelaxingBeams, StrainsStayWithTheirBeams) {
  Simulation simulation(relaxing_arm("world").scene);
  take_steps(simulation, 20);
  constexpr std::size_t kFirst = 3 * 2, kPoints = 2 * 2;  // of the lower beam
  const std::vector<Vector6> before = state_of(simulation).branch_strains;
  ASSERT_EQ(before.size(), 2 * (kFirst + kPoints));
  remove(simulation, "upper");
  const std::vector<Vector6>& after = state_of(simulation).branch_strains;
  ASSERT_EQ(after.size(), kPoints);
  for (std::size_t k = 0; k < kPoints; ++k) {
    EXPECT_EQ(after[k], before[2 * (kFirst + k)]);
    EXPECT_GT(after[k].norm(), 0);
  }
  take_steps(simulation, 5);
}

TEST(RelaxingBeams, SectionsShowTheStressOfAllSprings) {
  SceneBuilder b;
  b.scene.integrator.step = 1e-3;
  const scene::DirectSection section{1e4, 1e3, 1e3, 20, 25, 25, 0.5, 2e-3, 1e-3, 1e-3};
  b.beam("rod", {{1, 0, 0}}, section, 1, 1).maxwell = {{0.5, 1e6}};
  b.joint("clamp", JointKind::Fixed, "world", "rod");
  b.load("rod", {1, 0, 0}, {10, 0, 0});
  Simulation simulation(b.scene);
  take_steps(simulation, 3);
  const BeamPoint middle = simulation.section(1, 0.5);
  EXPECT_GT(middle.strain[0], 0);
  EXPECT_NEAR(middle.resultant[0], 1.5e4 * middle.strain[0], 1e-8 * middle.resultant[0]);  // exp(-3e-9) is left
}

TEST(RelaxingBeams, AreToldByLinearModels) {
  Simulation simulation(relaxing_arm().scene);
  const LinearModel model = linearise(simulation);
  ASSERT_FALSE(model.left_out.empty());
  EXPECT_NE(model.left_out[0].find("<maxwell>"), std::string::npos);
}

// Derivatives with respect to the constants of Maxwell elements, against differences of whole runs. Their error is of
// order (difference / value)^2 = 1e-6.
TEST(RelaxingBeams, HaveDerivatives) {
  const Scene scene{R"(<robot name="r"> <parameter name="ratio" value="0.4"/> <parameter name="time" value="0.05"/>
    <link name="world"/> <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint>
    <link name="rod"> <beam elements="3" order="2"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="2e3" ga2="1e3" ga3="1e3" gj="2" ei2="2.5" ei3="2.5" mass="0.5" j1="2e-4" j2="1e-4" j3="1e-4"/>
      <damping> <maxwell modulus_ratio="${ratio}" relaxation_time="${time}"/> </damping> </beam> </link>
    <simulation> <gravity xyz="0 1 -9.81"/> <integrator scheme="em" step="5e-3" tolerance="1e-10"/>
      <probe name="end" link="rod" at="1 0 0"/> </simulation> </robot>)"};
  constexpr int kSteps = 60;
  Simulation simulation = scene.simulation();
  Sensitivities sensitivities(simulation, scene.request({"ratio", "time"}));
  for (int n = 0; n < kSteps; ++n) ASSERT_TRUE(sensitivities.step().converged);
  ASSERT_EQ(sensitivities.lost(), "");
  const auto place = [](const Simulation& of) -> Eigen::VectorXd { return of.probe(0).pose.position; };
  const Eigen::MatrixXd found = sensitivities.of(place);
  const std::pair<const char*, double> parameters[] = {{"ratio", 0.4}, {"time", 0.05}};
  for (int k = 0; k < 2; ++k) {
    const auto& [name, value] = parameters[k];
    const auto after = [&, name = name](double changed) {
      Simulation other = scene.simulation({{name, changed}});
      take_steps(other, kSteps);
      return place(other);
    };
    const double way = 1e-3 * value;
    const Eigen::VectorXd expected = (after(value + way) - after(value - way)) / (2 * way);
    EXPECT_GT(expected.norm(), 1e-3) << name;
    EXPECT_LE((found.col(k) - expected).norm(), 1e-4 * expected.norm()) << name;
  }
}

}  // namespace
}  // namespace flexarm::test
