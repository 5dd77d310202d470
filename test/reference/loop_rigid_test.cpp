// Tests loops of rigid links, closed by multipliers: closed-form motions, invariants, constraints.
#include <cmath>

#include "flexarm/model/model_error.h"
#include "joints/closure_maps.h"
#include "math/pi.h"
#include "reference/dynamics_runs.h"
#include "reference/ode.h"
#include "simulation/inside.h"
#include "support/closed_ring.h"

namespace flexarm::test {
namespace {

using Eigen::VectorXd;
using scene::JointKind;

/// A slender bar along z from its link origin. Its centre of mass is beside its middle.
void bar(SceneBuilder& b, const std::string& name, double mass, const Vector3& to, const Vector3& beside) {
  b.body(name, mass, 0.5 * to + beside, Vector3(0.1, 0.05, 0.08).asDiagonal());
}

/// Two equal cranks on a line carry a coupler parallel to this line. The coupler does not rotate, so the angle q of the
/// cranks from the downward vertical obeys, for any centre of mass of the coupler,
///   (J1 + J2 + m1 c1^2 + m2 c2^2 + m3 a^2) q'' = -g (m1 c1 + m2 c2 + m3 a) sin q.
SceneBuilder parallelogram(double start, JointKind closing = JointKind::Continuous) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  bar(b, "left", 1.2, {0, 0, -0.8}, {0, 0.1, 0});
  bar(b, "right", 0.7, {0, 0, -0.8}, {0, -0.2, 0});
  bar(b, "coupler", 2, {1, 0, 0}, {0.1, 0.3, -0.2});
  // The initial position is put into the joints' frames, so that all joint coordinates are 0 there.
  const Quaternion turned(Eigen::AngleAxisd(-start, kAcross));
  b.joint("left", JointKind::Continuous, "world", "left", {0, 0, 0}, kAcross).origin.orientation = turned;
  b.joint("right", JointKind::Continuous, "world", "right", {1, 0, 0}, kAcross).origin.orientation = turned;
  b.joint("knee", JointKind::Continuous, "left", "coupler", {0, 0, -0.8}, kAcross).origin.orientation =
      turned.conjugate();
  close_loop(b, "closing", closing, "right", "coupler", {1, 0, 0}, kAcross).origin.orientation = turned.conjugate();
  return b;
}

const double kInertia = 2 * 0.05 + 1.2 * 0.16 + 0.7 * 0.16 + 2 * 0.64, kMoment = 1.2 * 0.4 + 0.7 * 0.4 + 2 * 0.8;

double angle(const Simulation& s, const std::string& name) {
  return s.position(*s.find_coordinate(name));
}

/// Angle of the cranks from the vertical at time t.
double pendulum(double start, double rate, double t) {
  const OdeFunction f = [&](double, const VectorXd& y) {
    return VectorXd(Eigen::Vector2d(y[1], -9.81 * kMoment / kInertia * std::sin(y[0])));
  };
  return solve_ode(f, 0, t, Eigen::Vector2d(start, rate))[0];
}

TEST(RigidLoop, ParallelogramIsAPendulum) {
  const double start = 0.9, until = 1.6;
  const double exact = pendulum(start, 0.5, until);
  for (const char* scheme : {"em", "m1", "std", "newmark", "hht1", "edmc2", "em4"}) {
    double error[3];
    for (int refinement = 0; refinement < 3; ++refinement) {
      SceneBuilder b = parallelogram(start);
      initial_joint(b, "left", 0, -0.5);  // about +y, whereas q grows about -y
      Simulation simulation(b.scene, options(scheme, 0.04 / (1 << refinement), 1e-11));
      run(simulation, 40 << refinement);
      error[refinement] = std::abs(start - angle(simulation, "left") - exact);
      EXPECT_NEAR(angle(simulation, "right"), angle(simulation, "left"), 1e-10) << scheme;
    }
    const double order = std::log2(error[1] / error[2]), expected = std::string(scheme) == "em4" ? 4 : 2;
    EXPECT_NEAR(order, expected, 0.1) << scheme;
    EXPECT_LT(error[2], 2e-3) << scheme;
  }
}

/// Largest violation of the closing joint's constraints: distance of its points, and angle between its axes.
double opening(const Simulation& s) {
  double largest = 0;
  std::vector<NodePose> poses;
  for (const NodeState& node : state_of(s).nodes) poses.push_back(node_pose(node));
  for (const LoopClosure& closure : model_of(s).closures)
    for (const auto* list : {&closure.constraints, &closure.implied})
      for (const ClosureConstraint& constraint : *list)
        largest = std::max(
            largest,
            std::abs(closure_value(closure, constraint,
                                   {closure.parent < 0 ? NodePose() : poses[closure.parent], poses[closure.child]})));
  return largest;
}

TEST(RigidLoop, FourBarKeepsEnergyAndConstraintsOverAThousandSteps) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  bar(b, "crank", 1, {0, 0, 0.4}, {0.02, 0.1, 0});
  bar(b, "coupler", 2, {1.2, 0, 0.4}, {0, 0, 0.1});
  bar(b, "rocker", 1.5, {0, 0, 0.8}, {0.1, 0, 0});
  b.joint("ground", JointKind::Continuous, "world", "crank", {0, 0, 0}, kAcross);
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0, 0, 0.4}, kAcross);
  b.joint("foot", JointKind::Continuous, "world", "rocker", {1.2, 0, 0}, kAcross);
  close_loop(b, "hip", JointKind::Continuous, "rocker", "coupler", {1.2, 0, 0.4}, kAcross);
  initial_joint(b, "ground", 0, 4);
  for (const char* scheme : {"em", "std", "edmc2"}) {
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-10));
    EXPECT_EQ(simulation.degrees_of_freedom(), 3 + 2u) << "three constraints of the planar loop are implied";
    InvariantDrift drift(simulation);
    double worst = 0, least = 1e9, most = -1e9;
    run(simulation, 1000, [&] {
      drift.observe();
      worst = std::max(worst, opening(simulation));
      least = std::min(least, angle(simulation, "foot"));
      most = std::max(most, angle(simulation, "foot"));
    });
    EXPECT_LT(worst, 1e-10) << scheme;
    EXPECT_LT(drift.energy(), 1e-10) << scheme;
    EXPECT_GT(most - least, 0.5);
  }
}

TEST(RigidLoop, WorkOfADriveAccountsForTheEnergy) {
  SceneBuilder b = parallelogram(0.4);
  b.scene.motions.push_back({"right", TimeFunction::parse("0.6*(1-cos(3*t))"), {}});
  Simulation simulation(b.scene, options("em", 0.02, 1e-11));
  InvariantDrift drift(simulation);
  run(simulation, 50, [&] { drift.observe(); });
  EXPECT_LT(drift.energy(), 1e-11);
  EXPECT_NEAR(angle(simulation, "left"), angle(simulation, "right"), 1e-10);
  EXPECT_GT(std::abs(simulation.energies().work), 0.1);
}

// Small swings about the lowest position. The forces of the multipliers are part of the stiffness.
TEST(RigidLoop, NaturalFrequencyOfTheParallelogram) {
  const Simulation simulation(parallelogram(0).scene);
  const std::vector<Mode> modes = simulation.natural_modes(5);
  ASSERT_EQ(modes.size(), 1u);
  const double expected = std::sqrt(9.81 * kMoment / kInertia) / (2 * kPi);
  EXPECT_NEAR(modes[0].frequency / expected, 1, 1e-9);
}

TEST(RigidLoop, EquilibriumOfTheParallelogram) {
  Simulation simulation(parallelogram(0.3).scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  EXPECT_NEAR(angle(simulation, "left"), 0.3, 1e-9);
  EXPECT_NEAR(angle(simulation, "right"), 0.3, 1e-9);
}

// If coupler and cranks are at rest on one line, the coupler may turn either way. The loop does not determine which
// constraints hold.
TEST(RigidLoop, SingularAtTheStart) {
  EXPECT_THROW(Simulation(parallelogram(0.5 * kPi).scene, options("em", 0.01)), ModelError);
}

TEST(RigidLoop, TwoDrivesOnOneFreedom) {
  SceneBuilder b = parallelogram(0.4);
  b.scene.motions.push_back({"left", TimeFunction::parse("sin(t)"), {}});
  b.scene.motions.push_back({"right", TimeFunction::parse("sin(t)"), {}});
  Simulation agreeing(b.scene, options("em", 0.01));
  run(agreeing, 50);
  b.scene.motions.back().position = TimeFunction::parse("1.1*sin(t)");
  EXPECT_THROW(Simulation(b.scene), ModelError) << "the velocities at the start disagree";
  b.scene.motions.back().position = TimeFunction::parse("sin(t)+t^3");
  Simulation quarrelling(b.scene, options("em", 0.01));
  StepResult result;
  for (int n = 0; n < 50 && (result = quarrelling.step()).converged; ++n) {
  }
  EXPECT_EQ(result.reason, StepResult::Reason::OpenLoop) << to_string(result.reason);
}

// ---------------------------------------------------------------- in space

class FreeRing : public ::testing::TestWithParam<JointKind> {};

TEST_P(FreeRing, ConservesEnergyAndMomenta) {
  for (const char* scheme : {"em", "std", "m1"}) {
    Simulation simulation(free_ring(GetParam()).scene, options(scheme, 0.005, 1e-11));
    InvariantDrift drift(simulation);
    double worst = 0;
    run(simulation, 200, [&] {
      drift.observe();
      worst = std::max(worst, opening(simulation));
    });
    if (std::string(scheme) != "m1") {  // conserves momenta only
      EXPECT_LT(drift.energy(), 1e-11) << scheme;
    }
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
    EXPECT_LT(worst, 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, FreeRing,
                         ::testing::Values(JointKind::Fixed, JointKind::Continuous, JointKind::Prismatic,
                                           JointKind::Spherical, JointKind::Universal, JointKind::Cylindrical,
                                           JointKind::PinSlot, JointKind::Planar));

}  // namespace
}  // namespace flexarm::test
