// Tests the forces that joints transmit: they balance the loads and the rates of momenta of the links outboard of the
// joint.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/loops.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

constexpr double kStep = 2e-3;
const Vector3 kForce(3, -2, 5);

std::size_t link_index(const Simulation& simulation, const std::string& name) {
  const std::vector<std::string>& names = simulation.link_names();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// A flexible arm on a hinge away from the world's origin. A constant force pulls a body at its end.
SceneBuilder pulled_arm() {
  SceneBuilder b;
  b.beam("arm", {{0.6, 0, 0}, {0.9, 0.2, 0.1}}, section(2e4, 1e4, 200, 250, 0.5, 0.02, 0.01), 3, 2);
  b.joint("hinge", scene::JointKind::Revolute, "world", "arm", {0.3, -0.2, 0.5}, {0, 0.6, 0.8});
  b.body("hand", 0.7, {0.05, 0.02, 0}, Vector3(0.01, 0.02, 0.015).asDiagonal());
  b.joint("wrist", scene::JointKind::Spherical, "arm", "hand", {0.9, 0.2, 0.1});
  b.load("hand", {0.1, 0, 0}, kForce);
  b.probe("hand", "hand", {0.1, 0, 0});
  b.sensor("root", scene::SensorKind::Reaction, "arm");
  b.scene.initial_joints.push_back({"hinge", 0.2, 1.5, {}});
  b.scene.integrator.tolerance = 1e-12;
  b.scene.integrator.step = kStep;
  return b;
}

/// The value at the end of the last step, extrapolated from means over the last three steps (theory.md).
Vector3 at_end(const std::vector<Vector3>& means) {
  const std::size_t n = means.size();
  return means[n - 1] + 0.5 * (means[n - 2] - means[n - 3]);
}

class Reactions : public ::testing::TestWithParam<std::string> {};

// In these schemes the balance is exact, up to the tolerance of Newton's method and the round-off of momenta over a
// step.
TEST_P(Reactions, OfTheRootBalanceLoadsAndRatesOfMomenta) {
  SceneBuilder b = pulled_arm();
  b.scene.integrator.scheme = GetParam();
  Simulation simulation(b.scene);
  const std::size_t arm = link_index(simulation, "arm");
  const Vector3 root = simulation.link_pose(arm).position;
  std::vector<Vector3> forces, moments;
  Vector3 momentum = simulation.momentum(), spin = simulation.angular_momentum(),
          hand = simulation.probe(0).pose.position;
  double scale = 0, error = 0;
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const Vector3 next = simulation.momentum(), next_spin = simulation.angular_momentum();
    const Vector3 next_hand = simulation.probe(0).pose.position;
    forces.push_back((next - momentum) / kStep - kForce);
    moments.push_back((next_spin - spin) / kStep - (0.5 * (hand + next_hand)).cross(kForce) -
                      root.cross(forces.back()));
    momentum = next, spin = next_spin, hand = next_hand;
    if (forces.size() < 3) continue;
    const Wrench reaction = simulation.reaction(arm);
    scale = std::max({scale, reaction.force.norm(), reaction.moment.norm()});
    error = std::max({error, (reaction.force - at_end(forces)).norm(), (reaction.moment - at_end(moments)).norm()});
  }
  EXPECT_GT(scale, kForce.norm());
  EXPECT_LE(error, 1e-10 * scale);
}
INSTANTIATE_TEST_SUITE_P(Schemes, Reactions, ::testing::Values("em", "em0", "edmc2", "m1", "em_symmetric"));

// The Newmark family has forces at the ends of steps. Their means give the change of momentum exactly; moments are
// exact only to second order.
TEST(Reactions, OfNewmarkBalanceRatesOfMomentum) {
  SceneBuilder b = pulled_arm();
  b.scene.integrator.scheme = "newmark";
  Simulation simulation(b.scene);
  const std::size_t arm = link_index(simulation, "arm");
  std::vector<Vector3> forces;
  Vector3 momentum = simulation.momentum();
  double scale = 0, error = 0;
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    forces.push_back((simulation.momentum() - momentum) / kStep - kForce);
    momentum = simulation.momentum();
    if (n < 5) continue;  // before the start there are no forces
    scale = std::max(scale, forces.back().norm());
    error = std::max(error, (simulation.reaction(arm).force - at_end(forces)).norm());
  }
  EXPECT_LE(error, 1e-10 * scale);
}

// The moment about a driven axis equals the drive's effort. Both do the same work over a step, in which the joint turns
// by u. The effort does it over u, the moment over 2 tan(u/2), which is larger by u^2/12.
TEST(Reactions, ContainTheDrive) {
  SceneBuilder b = pulled_arm();
  b.scene.initial_joints.clear();
  b.scene.motions.push_back({"hinge", TimeFunction::parse("0.3*sin(4*t)"), {}});
  Simulation simulation(b.scene);
  const std::size_t arm = link_index(simulation, "arm");
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(simulation.step().converged);
  const double effort = simulation.effort(0);
  EXPECT_GT(std::abs(effort), 0.1);
  const double turn = 0.3 * 4 * kStep;
  EXPECT_NEAR(simulation.reaction(arm).moment.dot(Vector3(0, 0.6, 0.8)), effort, turn * turn / 12 * std::abs(effort));
}

// A fixed link is merged into the body of the other link, unless a sensor needs the reaction between them.
TEST(Reactions, HoldAFixedPayload) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -10};
  b.body("arm", 1, {0.2, 0, 0}, 0.1 * Matrix3::Identity());
  b.joint("mount", scene::JointKind::Fixed, "world", "arm", {0, 0, 1});
  b.body("payload", 2, {0.1, 0.3, 0}, 0.1 * Matrix3::Identity());
  scene::JointDescription& grip = b.joint("grip", scene::JointKind::Fixed, "arm", "payload", {0.4, 0, 0});
  grip.origin.orientation = Quaternion(Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Vector3::UnitZ()));
  b.body("pendulum", 0.5, {0, 0, -0.1}, 0.1 * Matrix3::Identity());
  b.joint("free", scene::JointKind::Revolute, "payload", "pendulum", {0, 0, 0}, {0, 1, 0});
  b.sensor("grip", scene::SensorKind::Reaction, "payload");
  b.sensor("cell", scene::SensorKind::Wrench, "payload", {0.1, 0, 0});
  b.sensor("base", scene::SensorKind::Reaction, "arm");
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const Wrench grip_wrench = simulation.reaction(link_index(simulation, "payload"));
  // The payload's x axis is the world's y axis. Its mass hangs at (-0.3, 0.1) from the grip.
  EXPECT_LE((grip_wrench.force - Vector3(0, 0, 25)).norm(), 1e-12);
  EXPECT_LE((grip_wrench.moment - Vector3(-0.3, 0.1, 0).cross(Vector3(0, 0, 20))).norm(), 1e-12);
  const SensorSample& cell = simulation.sample(1);
  // Moment about a point 0.1 m further along the link's x axis, in the link's axes.
  const Vector3 moment = Vector3(0.1, 0.3, 0).cross(Vector3(0, 0, 20)) - Vector3(0.1, 0, 0).cross(Vector3(0, 0, 25));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(cell.values[3 + k], moment[k], 1e-12);
  EXPECT_NEAR(cell.values[2], 25, 1e-12);
  EXPECT_LE((simulation.reaction(link_index(simulation, "arm")).force - Vector3(0, 0, 35)).norm(), 1e-12);
}

TEST(Reactions, AreThereForLinksOfWhichSomebodyAsks) {
  Simulation simulation(pulled_arm().scene);
  EXPECT_THROW(simulation.reaction(link_index(simulation, "hand")), std::invalid_argument);
  EXPECT_EQ(simulation.reaction(link_index(simulation, "arm")).force, Vector3(0, 0, 0));
}

// A cantilever after one step: the clamp carries the resultant of the first section.
TEST(Reactions, AgreeWithTheSectionForceAtRest) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(2e4, 1e4, 200, 250, 0.5, 0.02, 0.01), 4, 2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 1e-4, 2e-4});
  b.sensor("root", scene::SensorKind::Reaction, "arm");
  b.scene.integrator.tolerance = 1e-12;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const Wrench reaction = simulation.reaction(1);
  EXPECT_LE((reaction.force - Vector3(0, -1e-4, -2e-4)).norm(), 2e4 * 1e-15);  // stiffness times round-off of strains
  // The force of the part before the section on the part behind it is minus the resultant.
  const BeamPoint section = simulation.section(1, 0);
  EXPECT_LE((reaction.moment + section.resultant.tail<3>()).norm(), 1e-6 * reaction.moment.norm());
}

/// A rod between two hinges about y: of the tree at its root, of a loop at its end. It sags under its weight.
SceneBuilder rod_on_two_hinges() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.beam("rod", {{1, 0, 0}}, section(2e4, 1e4, 1, 1, 0.1, 2e-5, 1e-5), 8, 2);
  b.joint("pin", scene::JointKind::Revolute, "world", "rod", {0, 0, 0}, {0, 1, 0});
  close_loop(b, "end", scene::JointKind::Revolute, "world", "rod", {1, 0, 0}, {0, 1, 0});
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

Vector3 moment_of(const Simulation& simulation, std::size_t sensor) {
  const auto& values = simulation.sample(sensor).values;
  return {values[3], values[4], values[5]};
}

// A hinge transmits no moment about its axis. `at` is the point of the section there, which turns and sags, and the
// other link's end of the hinge is at the same place.
TEST(Reactions, OfALoopAreAboutAPointOfTheSection) {
  for (const std::string scheme : {"em", "newmark"}) {
    SceneBuilder b = rod_on_two_hinges();
    b.scene.integrator.scheme = scheme;
    b.sensor("end", scene::SensorKind::Reaction, "rod", {1, 0, 0});
    b.sensor("wall", scene::SensorKind::Wrench, "world", {1, 0, 0});
    b.sensor("middle", scene::SensorKind::Reaction, "rod", {0.5, 0, 0});
    for (scene::Sensor& sensor : b.scene.sensors) sensor.joint = "end";
    b.sensor("root", scene::SensorKind::Reaction, "rod");
    Simulation simulation(b.scene);
    // Moments have round-off of the forces, which are as large as stiffness times round-off of strains.
    const auto check = [&](double weight, double round_off) {
      const Vector3 force = simulation.sensed_wrench(0).wrench.force;
      EXPECT_GT(force.z(), weight) << scheme;
      EXPECT_NEAR(moment_of(simulation, 0).y(), 0, round_off) << scheme;
      EXPECT_NEAR(moment_of(simulation, 1).y(), 0, round_off) << scheme;
      EXPECT_NEAR(moment_of(simulation, 3).y(), 0, round_off) << scheme;
      EXPECT_LE((simulation.sensed_wrench(1).wrench.force + force).norm(), round_off) << "the opposite on the world";
      EXPECT_LE((simulation.sensed_wrench(2).position - simulation.section(1, 0.5).pose.position).norm(), 1e-15);
    };
    ASSERT_TRUE(simulation.solve_static(1).converged);
    EXPECT_LT(simulation.section(1, 0.5).pose.position.z(), -5 * 0.981 / 384 / 2) << "it sags, held by tension, too";
    check(0.45 * 0.981, 1e-10);
    const Vector3 arm = simulation.section(1, 0.5).pose.position - simulation.section(1, 1).pose.position,
                  force = simulation.sensed_wrench(0).wrench.force;
    EXPECT_NEAR(moment_of(simulation, 2).y(), -arm.cross(force).y(), 1e-10) << scheme;
    simulation.reset();
    for (int n = 0; n < 50; ++n) ASSERT_TRUE(simulation.step().converged);  // straight at first, it falls
    check(0, 1e-8);
  }
}

// In motion, what is sensed is found from means over steps, moments as well as forces. A moment is the force times its
// arm to second order in the step.
TEST(Reactions, OfALoopAboutTheMiddleOfAMovingRod) {
  for (const std::string scheme : {"em", "newmark"}) {
    std::vector<double> errors;
    for (const int halvings : {0, 1, 2}) {
      SceneBuilder b = rod_on_two_hinges();
      b.scene.integrator.scheme = scheme;
      b.scene.integrator.step = 1e-3 / (1 << halvings);
      b.sensor("end", scene::SensorKind::Reaction, "rod", {1, 0, 0});
      b.sensor("middle", scene::SensorKind::Reaction, "rod", {0.5, 0, 0});
      for (scene::Sensor& sensor : b.scene.sensors) sensor.joint = "end";
      Simulation simulation(b.scene);
      for (int n = 0; n < 50 << halvings; ++n) ASSERT_TRUE(simulation.step().converged);
      const Vector3 arm = simulation.section(1, 1).pose.position - simulation.section(1, 0.5).pose.position;
      errors.push_back((moment_of(simulation, 1) - arm.cross(simulation.sensed_wrench(0).wrench.force)).norm());
    }
    for (std::size_t i = 1; i < errors.size(); ++i)
      EXPECT_NEAR(std::log2(errors[i - 1] / errors[i]), 2, 0.3) << scheme << errors[i];
  }
}

// A dead force at the tip is all that acts, so the clamp's wrench has no moment about the tip, wherever that is.
TEST(Reactions, OfAClampHaveNoMomentAboutALoadedTip) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(2e4, 1e4, 0.8, 1, 0.5, 0.02, 0.01), 6, 2);
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 1, 3});
  b.sensor("about tip", scene::SensorKind::Reaction, "arm", {1, 0, 0});
  b.scene.integrator.tolerance = 1e-12;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(3).converged);
  EXPECT_GT(simulation.section(1, 1).pose.position.z(), 0.5);
  EXPECT_LE(moment_of(simulation, 0).norm(), 1e-10);
}

}  // namespace
}  // namespace flexarm::test
