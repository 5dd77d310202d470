// Tests that total energy - work + dissipation stays constant under every kind of load, drive and dissipation.
#include <functional>

#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// An arm under gravity: a revolute shoulder, a flexible upper arm, a revolute elbow, and a flexible forearm with a
/// body at its tip.
SceneBuilder arm() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("base", 2, {0, 0, 0.1}, body_inertia());
  b.beam("upper", {{1.5, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 100, 120, 100, 1, 0.02, 0.01, 0.01}, 2, 2);
  b.beam("fore", {{1, 0, 0.3}}, scene::DirectSection{2e4, 1e4, 1e4, 100, 120, 100, 1, 0.02, 0.01, 0.01}, 1, 3);
  b.body("hand", 0.5, {0.1, 0.05, 0}, 0.1 * body_inertia());
  b.joint("yaw", JointKind::Revolute, "world", "base", {0, 0, 0.5}, {0, 0, 1});
  b.joint("shoulder", JointKind::Revolute, "base", "upper", {0.1, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, "upper", "fore", {1.5, 0, 0}, {0, 1, 0});
  b.joint("grip", JointKind::Fixed, "fore", "hand", {1, 0, 0.3});
  initial_joint(b, "shoulder", 0.4, 0);
  initial_joint(b, "yaw", 0, 1);
  return b;
}

struct Influence {
  std::string name;
  std::function<void(SceneBuilder&)> add;
};

scene::JointDescription& joint_of(SceneBuilder& b, int index) {
  return b.scene.joints[index];
}

const std::vector<Influence>& influences() {
  static const std::vector<Influence> list = {
      {"gravity", [](SceneBuilder&) {}},
      {"dead_load",
       [](SceneBuilder& b) {
         b.load("fore", {1, 0, 0.3}, {3, 1, 2}, {0.1, 0.2, 0.3}, "sin(3*t)");
       }},
      {"follower_load",
       [](SceneBuilder& b) {
         b.load("upper", {0.75, 0, 0}, {0, 2, 5}, {0.5, 0, 0.2}, "cos(2*t)", scene::LoadFrame::Follower);
       }},
      {"eccentric_load",
       [](SceneBuilder& b) {
         b.load("hand", {0.2, 0.3, 0.1}, {1, 2, 3});
       }},
      {"distributed_loads",
       [](SceneBuilder& b) {
         b.scene.distributed_loads.push_back({"upper", {0, 1, 2}, scene::LoadFrame::World, TimeFunction(), {}});
         b.scene.distributed_loads.push_back({"fore", {0, 1, 2}, scene::LoadFrame::Follower, TimeFunction(), {}});
       }},
      {"efforts",
       [](SceneBuilder& b) {
         b.scene.efforts.push_back({"yaw", TimeFunction::parse("2*cos(t)"), {}});
         b.scene.efforts.push_back({"elbow", TimeFunction::parse("0:0 1:5 2:-5"), {}});
       }},
      {"dampers", [](SceneBuilder& b) { joint_of(b, 0).damping = joint_of(b, 2).damping = 0.5; }},
      {"friction", [](SceneBuilder& b) { joint_of(b, 0).friction = joint_of(b, 1).friction = 0.3; }},
      {"limits",
       [](SceneBuilder& b) {
         joint_of(b, 1).limits = scene::JointLimits{-0.2, 0.6};
         joint_of(b, 2).limits = scene::JointLimits{-0.3, 0.3};
       }},
      {"material_damping",
       [](SceneBuilder& b) {
         b.scene.links[2].beam->stiffness_proportional_damping = 1e-3;
         b.scene.links[3].beam->mass_proportional_damping = 0.2;
       }},
      {"prescribed_motion",
       [](SceneBuilder& b) {
         b.scene.initial_joints.clear();
         b.scene.motions.push_back({"shoulder", TimeFunction::parse("0.4*sin(2*t)"), {}});
       }},
      {"mimic",
       [](SceneBuilder& b) {
         joint_of(b, 2).mimic = scene::Mimic{"shoulder", -1.5, 0.1};
         joint_of(b, 1).damping = 0.2;
       }},
  };
  return list;
}

SceneBuilder scene_with_everything() {
  SceneBuilder b = arm();
  for (const Influence& influence : influences())
    if (influence.name != "mimic" && influence.name != "prescribed_motion") influence.add(b);
  // A second arm gets the influences that exclude others.
  b.body("left", 1, {0.2, 0, 0}, body_inertia());
  b.body("right", 1, {0.2, 0.1, 0}, body_inertia());
  b.body("follower", 1, {0.2, 0.1, 0}, body_inertia());
  b.joint("driven", JointKind::Prismatic, "hand", "left", {0.1, 0, 0}, {0, 1, 0});
  b.joint("swinging", JointKind::Revolute, "left", "right", {0.2, 0, 0}, {0, 1, 0});
  b.joint("mimicking", JointKind::Revolute, "right", "follower", {0.2, 0, 0}, {0, 1, 0}).mimic =
      scene::Mimic{"swinging", 2, -0.1};
  b.scene.motions.push_back({"driven", TimeFunction::parse("0.1*(1-cos(3*t))"), {}});
  return b;
}

/// Expects that the balance closes to round-off. With the tolerance 1e-10 on updates, the last quadratic iteration
/// leaves only round-off in each step; 1e-10 covers the sum over the run.
void expect_balance(const SceneBuilder& builder, double step) {
  Simulation simulation(builder.scene, options("em", step, 1e-10));
  InvariantDrift drift(simulation);
  int halvings = 0;
  for (int n = 0; n < 1000; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << to_string(result.reason) << " at t = " << simulation.time();
    halvings += result.halvings;
    drift.observe();
  }
  EXPECT_LT(drift.energy(), 1e-10) << halvings << " halvings";
}

class EnergyBudget : public ::testing::TestWithParam<Influence> {};

TEST_P(EnergyBudget, ClosesToRoundOff) {
  SceneBuilder b = arm();
  GetParam().add(b);
  expect_balance(b, 0.01);
}
INSTANTIATE_TEST_SUITE_P(Influences, EnergyBudget, ::testing::ValuesIn(influences()),
                         [](const auto& info) { return info.param.name; });

TEST(EnergyBudget, ClosesWithEverythingAtOnce) {
  expect_balance(scene_with_everything(), 0.005);
}

TEST(EnergyBudget, WorkOfAConstantForceIsForceTimesDisplacement) {
  SceneBuilder b = arm();
  b.load("fore", {1, 0, 0.3}, {3, 1, 2});
  b.probe("tip", "fore", {1, 0, 0.3});
  Simulation simulation(b.scene, options("em", 0.01));
  const Vector3 start = simulation.probe(0).pose.position;
  run(simulation, 300);
  const double expected = Vector3(3, 1, 2).dot(simulation.probe(0).pose.position - start);
  EXPECT_NEAR(simulation.energies().work, expected, 1e-12 * (1 + std::abs(expected)) * 300);
}

// The dissipated energy never decreases, for any source of dissipation.
TEST(EnergyBudget, DissipationIsMonotone) {
  for (const std::string name : {"dampers", "friction", "limits", "material_damping"}) {
    SceneBuilder b = arm();
    for (const Influence& influence : influences())
      if (influence.name == name) influence.add(b);
    Simulation simulation(b.scene, options("em", 0.01));
    double before = 0;
    run(simulation, 500, [&] {
      EXPECT_GE(simulation.energies().dissipated, before) << name << " at t = " << simulation.time();
      before = simulation.energies().dissipated;
    });
    EXPECT_GT(before, 1e-3) << name;
  }
}

}  // namespace
}  // namespace flexarm::test
