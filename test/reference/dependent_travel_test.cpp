// Tests joints whose travel depends on an angle (screw, rack and pinion, worm, cam) against closed forms and by
// invariants.
#include <cmath>

#include "math/pi.h"
#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A wheel of mass 2 and rotary inertia 0.3 about its axis z. A joint with dependent travel connects it to the world.
SceneBuilder wheel(JointKind kind) {
  SceneBuilder b;
  b.body("wheel", 2, Vector3::Zero(), Vector3(0.2, 0.25, 0.3).asDiagonal());
  scene::JointDescription& joint = b.joint("joint", kind, "world", "wheel", {0.1, 0.2, 0.3}, {0, 0, 1});
  joint.ratio = 0.4;
  joint.direction = kind == JointKind::Screw ? Vector3::UnitZ() : Vector3::UnitX();
  joint.offset = 0.15;
  if (kind == JointKind::Cam) joint.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.5, 0.1));
  return b;
}

double angle(const Simulation& simulation) {
  return simulation.position(0);
}

// A constant effort or weight accelerates the wheel by Q / (J + m c^2). This is exact in every step.
TEST(DependentTravel, ScrewUnderItsWeight) {
  SceneBuilder b = wheel(JointKind::Screw);
  b.scene.gravity = {0, 0, -9.81};
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  run(simulation, 50);
  const double acceleration = -2 * 9.81 * 0.4 / (0.3 + 2 * 0.4 * 0.4);
  // The tangent-scaled rule turns by 2 atan(h W / 2): an error of third order in the angle of a step, here below 0.08.
  EXPECT_NEAR(angle(simulation), 0.5 * acceleration * 0.25, 0.5 * 0.5 * std::abs(acceleration) * 0.25 * 0.08 * 0.08);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), 0.3 + 0.4 * angle(simulation), 1e-14);
  EXPECT_LT((simulation.link_pose(1).position.head<2>() - Eigen::Vector2d(0.1, 0.2)).norm(), 1e-14);
}

TEST(DependentTravel, PinionRollsOnItsRack) {
  SceneBuilder b = wheel(JointKind::RackAndPinion);
  b.probe("centre", "wheel", {0, 0, 0});
  b.scene.efforts.push_back({"joint", TimeFunction(1.5), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  // The centre is beside the pitch line by the radius, and the point of contact is at rest.
  EXPECT_LT((simulation.link_pose(1).position - Vector3(0.1, 0.2 - 0.4, 0.3)).norm(), 1e-15);
  run(simulation, 100);
  EXPECT_NEAR(angle(simulation), 0.5 * 1.5 / (0.3 + 2 * 0.16), 1e-4);
  const Pose pose = simulation.link_pose(1);
  EXPECT_LT((pose.position - Vector3(0.1 + 0.4 * angle(simulation), -0.2, 0.3)).norm(), 1e-14);
  // The node's own velocity and spin satisfy rolling. They follow increments of travel and angle, which differ by the
  // tangent-scaled rule, to second order in the angle of a step.
  const ProbeState centre = simulation.probe(0);
  const double spin = simulation.velocity(0), turned = 0.01 * spin;
  EXPECT_NEAR(centre.velocity.x(), 0.4 * spin, 0.4 * spin * turned * turned);
  EXPECT_LT(centre.velocity.tail<2>().norm(), 1e-12);
}

TEST(DependentTravel, WormTravelsBesideItsAxis) {
  SceneBuilder b = wheel(JointKind::Worm);
  initial_joint(b, "joint", 0.7, 2);
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  const double energy = simulation.energies().total();
  EXPECT_NEAR(energy, 0.5 * 4 * (0.3 + 2 * 0.16), 1e-14);
  run(simulation, 100);
  EXPECT_NEAR(simulation.energies().total(), energy, 1e-12);
  EXPECT_LT((simulation.link_pose(1).position - Vector3(0.1 + 0.4 * angle(simulation), 0.2 - 0.15, 0.3)).norm(), 1e-13);
}

// The single coordinate obeys (J + m f'^2) u'' + m f' f'' u'^2 = 0, so u' follows from the energy.
TEST(DependentTravel, CamKeepsItsEnergyAndFollowsItsProfile) {
  for (const bool table : {false, true}) {
    SceneBuilder b = wheel(JointKind::Cam);
    if (table)
      b.scene.joints[0].profile = std::make_shared<CamProfile>(
          CamProfile::periodic({0, 0.9, 1.7, 2.9, 4, 5.2}, {0.1, 0.3, 0.35, 0.1, -0.2, -0.1}));
    initial_joint(b, "joint", 0.3, 3);
    Simulation simulation(b.scene, options("em", 0.005, 1e-12));
    const CamProfile& f = *b.scene.joints[0].profile;
    const double energy = simulation.energies().total();
    double least = 1e9, most = 0;
    run(simulation, 1000, [&] {
      const double u = angle(simulation), rate = simulation.velocity(0), slope = f.derivative(u);
      EXPECT_NEAR(simulation.link_pose(1).position.x(), 0.1 + f.value(u), 1e-13);
      // Error of Newton's method, 1e-15 rad times the tangent 4 J / h^2, does work over 0.015 rad in each of 1000
      // steps.
      EXPECT_NEAR(simulation.energies().total(), energy, 1000 * 1e-15 * 4 * 0.3 / (0.005 * 0.005) * 0.015);
      const double expected = std::sqrt(2 * energy / (0.3 + 2 * slope * slope));
      EXPECT_NEAR(rate, expected, 0.03 * expected);  // velocities of slaves satisfy the constraint to second order
      least = std::min(least, rate);
      most = std::max(most, rate);
    });
    EXPECT_GT(angle(simulation), 2 * kPi);  // more than a turn
    EXPECT_GT(most, 1.2 * least);
  }
}

TEST(DependentTravel, StopsAndMotionsAreThoseOfTheAngle) {
  SceneBuilder b = wheel(JointKind::Screw);
  b.scene.gravity = {0, 0, -9.81};
  b.scene.joints[0].limits = scene::JointLimits{-0.5, 0.5};
  b.scene.joints[0].damping = 2;
  Simulation simulation(b.scene, options("em", 0.005));
  run(simulation, 2000);
  EXPECT_NEAR(angle(simulation), -0.5, 0.02);

  SceneBuilder driven = wheel(JointKind::Cam);
  driven.scene.motions.push_back({"joint", TimeFunction::parse("2*t"), {}});
  Simulation driver(driven.scene, options("em", 0.01));
  run(driver, 100);
  EXPECT_NEAR(driver.link_pose(1).position.x(), 0.1 + driven.scene.joints[0].profile->value(2), 1e-12);
  // The work of the drive equals the change of energy.
  const Energies e = driver.energies();
  EXPECT_NEAR(e.total() - e.work, 0.5 * 4 * 0.3, 1e-9);  // at the start f' = 0
}

class FreeTreeWith : public ::testing::TestWithParam<JointKind> {};

TEST_P(FreeTreeWith, ConservesEnergyAndMomenta) {
  SceneBuilder b = free_tree(GetParam());
  for (scene::JointDescription& joint : b.scene.joints) {
    joint.ratio = 0.3;
    joint.offset = 0.2;
    joint.direction = joint.axis.unitOrthogonal();
    if (joint.kind == JointKind::Cam)
      joint.profile = std::make_shared<CamProfile>(
          CamProfile::periodic({0, 0.9, 1.7, 2.9, 4, 5.2}, {0.1, 0.3, 0.35, 0.1, -0.2, -0.1}));
  }
  for (const char* scheme : {"em", "std", "beta2_repaired"}) {
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-10));
    InvariantDrift drift(simulation);
    run(simulation, 300, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), 1e-10) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(JointKinds, FreeTreeWith,
                         ::testing::Values(JointKind::Screw, JointKind::RackAndPinion, JointKind::Worm,
                                           JointKind::Cam));

}  // namespace
}  // namespace flexarm::test
