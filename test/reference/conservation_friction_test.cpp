// Tests the account of dry friction: the energy budget closes, and friction inside a free system changes no momentum.
#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using Law = scene::FrictionDescription::Law;

/// A flexible arm under gravity, with joints of every kind that has a normal force, and a slider on the upper arm.
SceneBuilder rubbing_arm(Law law, double effort, double coefficient) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  const scene::DirectSection s{2e4, 1e4, 1e4, 100, 120, 100, 1, 0.02, 0.01, 0.01};
  b.body("base", 2, {0, 0, 0.1}, body_inertia());
  b.beam("upper", {{1.5, 0, 0}}, s, 3, 2);
  b.beam("fore", {{1, 0, 0.3}}, s, 1, 3);
  b.body("hand", 0.5, {0.1, 0.05, 0}, 0.1 * body_inertia());
  b.body("runner", 0.5, {0, 0.05, -0.1}, 0.1 * body_inertia());
  b.body("nut", 0.5, {0, 0.05, -0.1}, 0.1 * body_inertia());
  b.joint("yaw", JointKind::Revolute, "world", "base", {0, 0, 0.5}, {0, 0, 1});
  b.joint("shoulder", JointKind::Revolute, "base", "upper", {0.1, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, "upper", "fore", {1.5, 0, 0}, {0, 1, 0});
  b.joint("grip", JointKind::Universal, "fore", "hand", {1, 0, 0.3}, {1, 0, 0}).axis2 = {0, 0, 1};
  b.joint("slide", JointKind::Slide, "upper", "runner", {0, 0, 0}, {0, 1, 0}).slide =
      scene::SlideDescription{0.3, JointKind::Revolute};
  b.joint("thread", JointKind::Screw, "fore", "nut", {0.5, 0, 0}, {1, 0, 0}).ratio = 0.02;
  for (scene::JointDescription& joint : b.scene.joints) {
    joint.friction = joint.name == "yaw" || joint.name == "shoulder" || joint.name == "elbow" ? effort : 0.3 * effort;
    joint.friction_law = {law, coefficient, 0.05};
  }
  initial_joint(b, "shoulder", 0.4, 0);
  initial_joint(b, "yaw", 0, 1);
  return b;
}

/// Newton's method leaves only round-off in each step; 1e-10 covers the sum over the run.
TEST(RubbingArm, BudgetClosesToRoundOff) {
  for (const double effort : {0.3, 3.0})
    for (const double coefficient : {0.0, 0.5})
      for (const std::string scheme : {"em", "em_symmetric", "std"}) {
        Simulation simulation(rubbing_arm(Law::Coulomb, effort, coefficient).scene, options(scheme, 0.002, 1e-10));
        InvariantDrift drift(simulation);
        int held = 0, iterations = 0;
        double dissipated = 0;
        for (int n = 0; n < 1000; ++n) {
          const StepResult result = simulation.step();
          ASSERT_TRUE(result.converged) << scheme << " " << to_string(result.reason) << " at " << simulation.time();
          iterations += result.iterations;
          drift.observe();
          for (const double rest : state_of(simulation).rests) held += rest > 0;
          ASSERT_GE(simulation.energies().dissipated, dissipated);
          dissipated = simulation.energies().dissipated;
        }
        EXPECT_LT(drift.energy(), 1e-10) << scheme << " " << effort << " " << coefficient;
        EXPECT_GT(held, effort > 1 ? 1000 : 100) << "several stick, and not for ever";
        EXPECT_LT(held, 8 * 1000);
        EXPECT_LT(iterations, 12 * 1000);
      }
}

// Friction that falls within a step, too.
TEST(RubbingArm, BudgetClosesWithMoreFrictionAtRest) {
  for (const double stribeck : {0.5, 0.05})
    for (const double step : {0.002, 0.0005})
      for (const Law law : {Law::Coulomb, Law::Smooth}) {
        SceneBuilder arm = rubbing_arm(law, 3, 0.5);
        for (scene::JointDescription& joint : arm.scene.joints)
          joint.friction_law.static_ratio = 1.5, joint.friction_law.stribeck_speed = stribeck;
        Simulation simulation(arm.scene, options("em", step, 1e-12));
        InvariantDrift drift(simulation);
        double dissipated = 0;
        for (int n = 0; n < 500; ++n) {
          ASSERT_TRUE(steps(simulation));
          drift.observe();
          ASSERT_GE(simulation.energies().dissipated, dissipated);
          dissipated = simulation.energies().dissipated;
        }
        EXPECT_LT(drift.energy(), 1e-10) << (law == Law::Smooth ? "smooth " : "coulomb ") << stribeck << " " << step;
      }
}

// Friction between parts of a free system changes neither its linear nor its angular momentum.
TEST(FreeTree, InternalFrictionKeepsMomenta) {
  for (const JointKind kind : {JointKind::Revolute, JointKind::Prismatic, JointKind::Universal, JointKind::Cylindrical})
    for (const Law law : {Law::Coulomb, Law::Smooth}) {
      SceneBuilder b = free_tree(kind);
      for (scene::JointDescription& joint : b.scene.joints)
        if (joint.kind == kind) joint.friction = 0.02, joint.friction_law = {law, 0.2, 0.05};
      Simulation simulation(b.scene, options("em", 0.01, 1e-11));
      InvariantDrift drift(simulation);
      run(simulation, 200, [&] { drift.observe(); });
      EXPECT_LT(drift.momentum(), 1e-12);
      EXPECT_LT(drift.angular_momentum(), 1e-11);
      EXPECT_LT(drift.energy(), 1e-11);
      EXPECT_GT(simulation.energies().dissipated, 0);
    }
}

}  // namespace
}  // namespace flexarm::test
