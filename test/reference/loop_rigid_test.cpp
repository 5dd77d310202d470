// Loops of rigid links, closed by multipliers: closed-form motions, invariants, constraints.
#include <cmath>

#include "reference/dynamics_runs.h"
#include "reference/ode.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using Eigen::VectorXd;
using scene::JointKind;

const Vector3 kAcross(0, 1, 0);

/// A slender bar along z from its link origin, with its centre beside its middle.
void bar(SceneBuilder& b, const std::string& name, double mass, const Vector3& to, const Vector3& beside) {
  b.body(name, mass, 0.5 * to + beside, Vector3(0.1, 0.05, 0.08).asDiagonal());
}

/// Two equal cranks on a line that carry a coupler parallel to that line: the coupler does not turn, so that
///   (J1 + J2 + m1 c1^2 + m2 c2^2 + m3 a^2) q'' = -g (m1 c1 + m2 c2 + m3 a) sin q
/// for the angle q of the cranks from the downward vertical, wherever the coupler has its centre of mass.
SceneBuilder parallelogram(double start, JointKind closing = JointKind::Continuous) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  bar(b, "left", 1.2, {0, 0, -0.8}, {0, 0.1, 0});
  bar(b, "right", 0.7, {0, 0, -0.8}, {0, -0.2, 0});
  bar(b, "coupler", 2, {1, 0, 0}, {0.1, 0.3, -0.2});
  // The position at the start is in the frames of the joints, so that all their coordinates are 0 there.
  const Quaternion turned(Eigen::AngleAxisd(-start, kAcross));
  b.joint("left", JointKind::Continuous, "world", "left", {0, 0, 0}, kAcross).origin.orientation = turned;
  b.joint("right", JointKind::Continuous, "world", "right", {1, 0, 0}, kAcross).origin.orientation = turned;
  b.joint("knee", JointKind::Continuous, "left", "coupler", {0, 0, -0.8}, kAcross).origin.orientation =
      turned.conjugate();
  close_loop(b, "closing", closing, "right", "coupler", {1, 0, 0}, kAcross).origin.orientation = turned.conjugate();
  return b;
}

double angle(const Simulation& s, const std::string& name) {
  return s.position(*s.find_coordinate(name));
}

/// Angle of the cranks from the vertical at time t.
double pendulum(double start, double rate, double t) {
  const double inertia = 2 * 0.05 + 1.2 * 0.16 + 0.7 * 0.16 + 2 * 0.64, weight = 9.81 * (1.2 * 0.4 + 0.7 * 0.4 + 2 * 0.8);
  const OdeFunction f = [&](double, const VectorXd& y) {
    return VectorXd(Eigen::Vector2d(y[1], -weight / inertia * std::sin(y[0])));
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
      initial_joint(b, "left", 0, -0.5);  // about +y, while q grows about -y
      Simulation simulation(b.scene, options(scheme, 0.04 / (1 << refinement), 1e-11));
      run(simulation, 40 << refinement);
      error[refinement] = std::abs(start - angle(simulation, "left") - exact);
      EXPECT_NEAR(angle(simulation, "right"), angle(simulation, "left"), 1e-10) << scheme;
    }
    printf("%s %g %g %g\n", scheme, error[0], error[1], error[2]);
    const double order = std::string(scheme) == "hht1" || std::string(scheme) == "edmc2" ? 1.5 : 1.8;
    EXPECT_GT(std::log2(error[1] / error[2]), order) << scheme;
    EXPECT_LT(error[2], 2e-3) << scheme;
  }
}

/// Largest violation of what the closing joint holds: distance of its places, and angle between its axes.
double opening(const Simulation& s) {
  double largest = 0;
  std::vector<NodePose> poses;
  for (const NodeState& node : s.state().nodes) poses.push_back(node_pose(node));
  for (const LoopClosure& closure : s.model().closures)
    for (const auto* list : {&closure.constraints, &closure.implied})
      for (const ClosureConstraint& constraint : *list)
        largest = std::max(largest, std::abs(closure_value(closure, constraint,
                                                           {closure.parent < 0 ? NodePose() : poses[closure.parent],
                                                            poses[closure.child]})));
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
    printf("%s energy %g opening %g\n", scheme, drift.energy(), worst);
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
  run(simulation, 100, [&] { drift.observe(); });
  EXPECT_LT(drift.energy(), 1e-11);
  EXPECT_NEAR(angle(simulation, "left"), angle(simulation, "right"), 1e-10);
  EXPECT_GT(std::abs(simulation.energies().work), 0.1);
}

// ---------------------------------------------------------------- in space

/// A floating trunk, two arms of two bodies in spherical and revolute joints, and a joint between their ends.
SceneBuilder free_ring(JointKind kind) {
  SceneBuilder b;
  b.body("trunk", 1, {0.1, 0, 0.05}, Vector3(0.05, 0.06, 0.07).asDiagonal());
  b.joint("flight", JointKind::Floating, "world", "trunk");
  const auto arm = [&](const std::string& name, double side) {
    b.body(name, 0.4, {0.2, 0.05 * side, 0.02}, Vector3(0.01, 0.02, 0.015).asDiagonal());
    b.body(name + "_end", 0.3, {0.1, -0.1 * side, 0}, Vector3(0.01, 0.008, 0.012).asDiagonal());
    b.joint(name, JointKind::Spherical, "trunk", name, {0, 0.2 * side, 0});
    b.joint(name + "_end", JointKind::Spherical, name, name + "_end", {0.4, 0.2 * side, 0.1});
  };
  arm("left", 1);
  arm("right", -1);
  scene::JointDescription& loop =
      close_loop(b, "loop", kind, "left_end", "right_end", {0.2, 0.3, 0.05}, {0.48, 0.6, 0.64});
  loop.axis2 = Vector3::UnitX();
  initial_joint(b, "left/rz", 0, 1.5);
  initial_joint(b, "flight/rx", 0, 1);
  initial_joint(b, "flight/ry", 0, -2);
  return b;
}

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
    printf("%s %g %g %g %g\n", scheme, drift.energy(), drift.momentum(), drift.angular_momentum(), worst);
    EXPECT_LT(drift.energy(), 1e-11) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
    EXPECT_LT(worst, 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, FreeRing,
                         ::testing::Values(JointKind::Fixed, JointKind::Continuous, JointKind::Prismatic,
                                           JointKind::Spherical, JointKind::Universal, JointKind::Cylindrical,
                                           JointKind::Planar));

}  // namespace
}  // namespace flexarm::test
