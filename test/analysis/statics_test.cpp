// Tests equilibria: stable ones, the search for them, and scenes without equilibrium.
#include "analysis/statics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "analysis/descent.h"
#include "analysis/flexible_dead_point.h"
#include "analysis/linearised_motion.h"
#include "analysis/stability.h"
#include "building/model_builder.h"
#include "math/pi.h"
#include "reference/slider_crank.h"
#include "simulation/inside.h"
#include "support/loops.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

constexpr double kEuler = kPi * kPi / 4;  // buckling load of the column, EI = L = 1
/// Accuracy of equilibria: the tolerance on updates of IntegratorDescription, where updates contract by at least a
/// half.
constexpr double kTolerance = 2e-8;

/// A clamped upright column.
SceneBuilder column(double load, double across) {
  SceneBuilder b;
  b.beam("beam", {{0, 0, 1}}, section(1e5, 5e4, 1, 1, 1, 1e-3, 5e-4), 8, 2);
  b.joint("clamp", JointKind::Fixed, "world", "beam");
  b.load("beam", {0, 0, 1}, {across, 0, -load});
  b.probe("tip", "beam", {0, 0, 1});
  return b;
}

/// Height of the tip of Euler's elastica, of length 1 and clamped below, under `ratio` > 1 times the buckling load.
double height_of_elastica(double ratio) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double k = (low + high) / 2;
    (std::comp_ellint_1(k) < kPi / 2 * std::sqrt(ratio) ? low : high) = k;
  }
  return 2 * std::comp_ellint_2(low) / std::comp_ellint_1(low) - 1;
}

/// A chain of rods of 1 m and 1 kg along x on hinges about y.
SceneBuilder pendulum(int links, const Vector3& gravity) {
  SceneBuilder b;
  b.scene.gravity = gravity;
  std::string parent = "world";
  for (int i = 0; i < links; ++i) {
    const std::string link = "rod" + std::to_string(i);
    b.body(link, 1, {0.5, 0, 0}, Vector3(0.01, 1. / 12, 1. / 12).asDiagonal());
    b.joint("hinge" + std::to_string(i), JointKind::Continuous, parent, link, {i == 0 ? 0. : 1., 0, 0}, {0, 1, 0});
    parent = link;
  }
  return b;
}

bool diverges(const Simulation& simulation) {
  return simulation.natural_modes(1).at(0).is_divergence();
}

TEST(Statics, ColumnBucklesWhatEverTheLoadSteps) {
  for (const double across : {0.0, 1e-3})
    for (const int load_steps : {1, 2, 20}) {
      Simulation simulation(column(3 * kEuler, across * 3 * kEuler).scene);
      ASSERT_TRUE(simulation.solve_static(load_steps).converged) << across << " " << load_steps;
      EXPECT_FALSE(diverges(simulation));
      // Bending strains of the elastica vary over two thirds of a wave. Elements of order two with h = 1/8 have an
      // error of (2/3 2 pi h)^4 / 180. The lateral load moves the tip by its own share.
      EXPECT_NEAR(simulation.probe(0).pose.position.z(), height_of_elastica(3),
                  std::pow(2. / 3 * 2 * kPi / 8, 4) / 180 + across);
    }
}

// Also tests interpolations whose strains depend on the past. Their tangents are not symmetric. The equilibrium is that
// of the interpolations with a potential.
TEST(Statics, StraightColumnIsToldAndCanBeHad) {
  for (const char* scheme : {"em", "std", "hht3"}) {
    SimulationOptions options;
    options.scheme = scheme;
    Simulation simulation(column(3 * kEuler, 0).scene, options);
    const StaticResult falls = simulation.solve_static(2);
    ASSERT_TRUE(falls.converged) << scheme;
    EXPECT_EQ(falls.falling_link, "beam") << scheme;
    EXPECT_LT(simulation.probe(0).pose.position.z(), 0.9) << scheme;
    simulation.reset();
    const StaticResult stays = simulation.solve_static(2, Equilibrium::UnderTheLoads);
    ASSERT_TRUE(stays.converged) << scheme;
    EXPECT_EQ(stays.falling_link, "beam") << scheme;
    EXPECT_LT(simulation.probe(0).pose.position.head<2>().norm(), kTolerance) << scheme;
    EXPECT_TRUE(diverges(simulation)) << scheme;
  }
}

TEST(Statics, AColumnBelowItsBucklingLoadStands) {
  Simulation simulation(column(0.98 * kEuler, 0).scene);
  const StaticResult result = simulation.solve_static(1);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.falling_link, "");
  EXPECT_LT(simulation.probe(0).pose.position.head<2>().norm(), kTolerance);
}

TEST(Statics, PendulumsHang) {
  for (const int links : {1, 2, 5})
    for (const Vector3& gravity : {Vector3(0, 0, -9.81), Vector3(-9.81, 0, 0), Vector3(9.81, 0, 0)}) {
      Simulation simulation(pendulum(links, gravity).scene);
      const StaticResult result = simulation.solve_static(10);
      ASSERT_TRUE(result.converged) << links << " " << gravity.transpose() << ": " << to_string(result.reason);
      EXPECT_EQ(result.falling_link.empty(), gravity.x() >= 0);
      const double turn = gravity.z() < 0 ? kPi / 2 : gravity.x() < 0 ? kPi : 0;
      EXPECT_NEAR(std::remainder(std::abs(simulation.position(0)) - turn, 2 * kPi), 0, kTolerance);
      for (int i = 1; i < links; ++i) EXPECT_NEAR(std::remainder(simulation.position(i), 2 * kPi), 0, kTolerance);
      EXPECT_FALSE(diverges(simulation));
    }
}

// The curvature of the potential by Sylvester's law, relative to Drag's: -m g l for an upright pendulum that turns by 1
// rad. Its nodes turn by 1 rad and move by 0.5 m then.
TEST(Stability, UprightPendulum) {
  SceneBuilder b = pendulum(1, {-9.81, 0, 0});
  const Simulation simulation(b.scene);
  const Stability up = judge_stability(model_of(simulation), state_of(simulation));
  EXPECT_FALSE(up.is_stable());
  EXPECT_EQ(up.motion.link, "rod0");
  const double moved = 0.5 / model_of(simulation).length_scale,
               ways = static_cast<double>(simulation.node_count()) * (1 + moved * moved);
  EXPECT_NEAR(up.motion.curvature * ways, -9.81 * 0.5, 1e-12 * 9.81);
}

Stability stability_at_start(const SceneBuilder& b) {
  const Simulation simulation(b.scene);
  return judge_stability(model_of(simulation), state_of(simulation));
}

// Chains of thousands of joints are judged without a dense matrix: a hanging chain, an upright one, and hanging rods
// with an upright one among them. An upright rod rotates about its hinge by 1 rad, with at most three nodes.
TEST(Stability, OfThousandsOfJoints) {
  constexpr int kLinks = 2000;
  EXPECT_TRUE(stability_at_start(pendulum(kLinks, {9.81, 0, 0})).is_stable());
  EXPECT_FALSE(stability_at_start(pendulum(kLinks, {-9.81, 0, 0})).is_stable());

  SceneBuilder rods = pendulum(kLinks, {9.81, 0, 0});
  for (scene::JointDescription& joint : rods.scene.joints) joint.parent = "world";
  EXPECT_TRUE(stability_at_start(rods).is_stable());
  rods.scene.initial_joints.push_back({"hinge700", kPi, 0, {}});
  const Stability stability = stability_at_start(rods);
  EXPECT_FALSE(stability.is_stable());
  EXPECT_EQ(stability.motion.link, "rod700");
  EXPECT_LE(stability.motion.curvature, -9.81 * 0.5 / 3);
}

/// A parallelogram of cranks of 1 m on a line and a coupler of 2 m, rotated by `angle` from this line. Links are beams,
/// except those named in `rigid`. `left`: kind of the left crank's joints.
SceneBuilder flexible_parallelogram(double angle, JointKind left, const std::set<std::string>& rigid = {}) {
  SceneBuilder b;
  const Vector3 across(0, 1, 0), crank(std::cos(angle), 0, std::sin(angle));
  const auto link = [&](const std::string& name, const Vector3& along, int elements) {
    if (rigid.count(name))
      b.body(name, 1, along / 2, 0.05 * Matrix3::Identity());
    else
      b.beam(name, {along}, section(1e5, 5e4, 10, 10, 1, 1e-2, 5e-3), elements, 2);
  };
  link("left", crank, 2);
  link("coupler", {2, 0, 0}, 4);
  link("right", crank, 2);
  b.joint("left_foot", left, "world", "left", {0, 0, 0}, across);
  b.joint("left_head", left, "left", "coupler", crank, across);
  b.joint("right_foot", JointKind::Continuous, "world", "right", {2, 0, 0}, across);
  close_loop(b, "right_head", JointKind::Continuous, "coupler", "right", crank, across).origin.position = {2, 0, 0};
  return b;
}

std::string dead_link(const SceneBuilder& b) {
  const Simulation simulation(b.scene);
  return link_at_dead_point(model_of(simulation), state_of(simulation));
}

// A flat parallelogram may open as a parallelogram or as a crossed one, with or without stretching. If crank and
// coupler are clamped, it would have to bend.
TEST(Stability, FlexibleLoopsAtDeadPoints) {
  EXPECT_NE(dead_link(flexible_parallelogram(0, JointKind::Continuous)), "");
  for (const double angle : {0.01, 0.3, kPi / 2})
    EXPECT_EQ(dead_link(flexible_parallelogram(angle, JointKind::Continuous)), "") << angle;
  EXPECT_EQ(dead_link(flexible_parallelogram(0, JointKind::Fixed)), "");
  EXPECT_EQ(dead_link(column(0, 0)), "");

  const std::set<std::string> rigid = {"coupler", "right"};  // closed by multipliers
  EXPECT_EQ(dead_link(flexible_parallelogram(0, JointKind::Continuous, rigid)), "left");
  for (const double angle : {0.01, 0.3, kPi / 2})
    EXPECT_EQ(dead_link(flexible_parallelogram(angle, JointKind::Continuous, rigid)), "") << angle;
  EXPECT_EQ(dead_link(flexible_parallelogram(0, JointKind::Fixed, rigid)), "");
  ASSERT_EQ(build_model(flexible_parallelogram(0, JointKind::Continuous, rigid).scene).closures.size(), 1u);
  for (const double slenderness : {1e5, 1e8}) {  // soft beams are no free motion
    SceneBuilder soft = flexible_parallelogram(0, JointKind::Fixed);
    for (scene::LinkDescription& link : soft.scene.links)
      if (link.beam) link.beam->section = section(10 * slenderness, 4 * slenderness, 10, 10, 1, 1e-2, 5e-3);
    EXPECT_EQ(dead_link(soft), "") << slenderness;
  }
  EXPECT_EQ(dead_link(pendulum(3, Vector3::Zero())), "");

  SceneBuilder ring;  // it flies freely, and is soft
  ring.beam("ring", {{1, 0, 1}, {0, 0, 2}, {-1, 0, 1}, {0, 0, 0}}, section(1e9, 4e8, 1, 1, 1, 2e-9, 1e-9), 16, 2);
  ring.joint("free", JointKind::Floating, "world", "ring");
  close_loop(ring, "weld", JointKind::Fixed, "ring", "ring").origin.position.setZero();
  EXPECT_EQ(dead_link(ring), "");
}

// Loops: zeros on the diagonal at multipliers are no instability, and motions that the loop prevents are none either.
TEST(Statics, LoopsFallAsTheyCan) {
  for (const double gravity : {-9.81, 9.81}) {
    SceneBuilder b;
    b.scene.gravity = Vector3(0, 0, gravity);
    const Matrix3 inertia = Vector3(0.1, 0.1, 0.01).asDiagonal();
    b.body("left", 1, {0, 0, 0.5}, inertia);
    b.body("right", 1, {0, 0, 0.5}, inertia);
    b.body("coupler", 1, {1, 0, 0}, inertia);
    b.joint("left_foot", JointKind::Continuous, "world", "left", {0, 0, 0}, {0, 1, 0});
    b.joint("head", JointKind::Continuous, "left", "coupler", {0, 0, 1}, {0, 1, 0});
    b.joint("right_foot", JointKind::Continuous, "world", "right", {2, 0, 0}, {0, 1, 0});
    close_loop(b, "other_head", JointKind::Continuous, "right", "coupler", {2, 0, 0}, {0, 1, 0});
    Simulation simulation(b.scene);
    const StaticResult result = simulation.solve_static(2);
    ASSERT_TRUE(result.converged) << to_string(result.reason);
    EXPECT_EQ(result.falling_link.empty(), gravity > 0);
    EXPECT_NEAR(std::abs(simulation.position(0)), gravity < 0 ? kPi : 0, kTolerance);
    EXPECT_FALSE(diverges(simulation));
  }
}

// Two shallow rods carry an apex that snaps through. There is no equilibrium near the end of the load path.
TEST(Statics, ShallowTrussSnapsThrough) {
  SceneBuilder b;
  const scene::DirectSection rod = section(1e5, 5e4, 10, 10, 1, 1e-2, 5e-3);
  b.beam("left", {{1, 0, 0.05}}, rod, 4, 2);
  b.beam("right", {{-1, 0, 0.05}}, rod, 4, 2);
  b.joint("left_foot", JointKind::Continuous, "world", "left", {0, 0, 0}, {0, 1, 0});
  b.joint("right_foot", JointKind::Continuous, "world", "right", {2, 0, 0}, {0, 1, 0});
  close_loop(b, "apex", JointKind::Continuous, "left", "right", {-1, 0, 0.05}, {0, 1, 0});
  b.load("left", {1, 0, 0.05}, {0, 0, -200});
  b.probe("apex", "left", {1, 0, 0.05});
  Simulation simulation(b.scene);
  const StaticResult result = simulation.solve_static(10);
  ASSERT_TRUE(result.converged) << to_string(result.reason);
  EXPECT_LT(simulation.probe(0).pose.position.z(), -0.05);
  EXPECT_FALSE(diverges(simulation));
}

TEST(Statics, WhatNothingHoldsNeverRests) {
  SceneBuilder b;
  b.beam("beam", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 2, 2);
  b.joint("free", JointKind::Floating, "world", "beam");
  b.load("beam", {1, 0, 0}, {1, 0, 0});
  Simulation simulation(b.scene);
  const StaticResult result = simulation.solve_static(1);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, StepResult::Reason::NeverRests);
}

TEST(Statics, WhatNothingMovesRestsAtItsStart) {
  Simulation simulation(pendulum(1, Vector3::Zero()).scene);
  const StaticResult result = simulation.solve_static(1);
  ASSERT_TRUE(result.converged) << to_string(result.reason);
  EXPECT_EQ(simulation.position(0), 0);
  EXPECT_EQ(result.loose_link, "rod0");
  EXPECT_EQ(result.falling_link, "");
}

// A beam that hangs on an upright hinge may be at rest at any angle about it.
TEST(Statics, WhatMayStandElsewhereIsTold) {
  SceneBuilder b;
  b.scene.gravity = Vector3(0, 0, -9.81);
  b.beam("beam", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 4, 2);
  b.joint("swivel", JointKind::Continuous, "world", "beam", Vector3::Zero(), {0, 0, 1});
  Simulation simulation(b.scene);
  const StaticResult result = simulation.solve_static(1);
  ASSERT_TRUE(result.converged) << to_string(result.reason);
  EXPECT_EQ(result.loose_link, "beam");
  EXPECT_EQ(result.falling_link, "");
}

/// An arm with a pan axis that is tilted by `tilt` from the vertical, and a lift and an elbow across it. Each link has
/// 0.1 kg and 0.1 m. If `is_flexible`, the upper arm is a beam.
SceneBuilder pan_lift_elbow(double tilt, bool is_flexible) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  const Matrix3 inertia = 1e-4 * Matrix3::Identity();
  b.body("bracket", 0.1, {0, 0, 0}, inertia);
  b.body("column", 0.1, {0, 0.02, 0}, inertia);
  if (is_flexible)
    b.beam("upper", {{0, 0.1, 0}}, section(1e6, 5e5, 50, 50, 1, 1e-4, 5e-5), 3, 2);
  else
    b.body("upper", 0.1, {0, 0.05, 0}, inertia);
  b.body("fore", 0.1, {0, 0.05, 0}, inertia);
  b.joint("mount", JointKind::Fixed, "world", "bracket", {0, 0, 0.1}).origin.orientation =
      Quaternion(Eigen::AngleAxisd(kPi / 2 - tilt, Vector3::UnitX()));
  b.joint("pan", JointKind::Continuous, "bracket", "column", {0, 0, 0}, {0, 1, 0});
  b.joint("lift", JointKind::Continuous, "column", "upper", {0, 0.05, 0}, {0, 0, 1});
  b.joint("elbow", JointKind::Continuous, "upper", "fore", {0, 0.1, 0}, {0, 0, 1});
  return b;
}

JointHold hold_of(const Simulation& simulation) {
  return joint_hold(model_of(simulation), state_of(simulation));
}

// The lowest equilibrium: column, upper arm and forearm are in the plane in which the pan axis is tilted, and the arms
// hang straight down. The forearm's end is then 0.2 m below the lift.
TEST(Statics, ArmsUnderATiltedPanAxisHang) {
  for (const double tilt : {7.963267948966e-4, 0.01, 1e-5})
    for (const bool is_flexible : {false, true}) {
      if (is_flexible && tilt < 1e-4) continue;  // round-off of the beam hides smaller tilts
      Simulation simulation(pan_lift_elbow(tilt, is_flexible).scene);
      const StaticResult result = simulation.solve_static(10);
      ASSERT_TRUE(result.converged) << tilt << ": " << to_string(result.reason);
      const std::size_t fore = simulation.link_names().size() - 1;
      const Pose end = simulation.link_pose(fore);
      const Vector3 lift(0, 0.05 * std::sin(tilt), 0.1 + 0.05 * std::cos(tilt));
      // The beam stretches by m g L / EA.
      const double stretch = is_flexible ? 2 * 0.2 * 9.81 * 0.1 / 1e6 : 0;
      EXPECT_LT((end.position - (lift - Vector3(0, 0, 0.1))).norm(), kTolerance + stretch) << tilt << is_flexible;
      EXPECT_LT((end.orientation * Vector3::UnitY() + Vector3::UnitZ()).norm(), 4 * kTolerance) << tilt << is_flexible;
      EXPECT_TRUE(hold_of(simulation).free.empty()) << tilt << is_flexible;
      EXPECT_FALSE(diverges(simulation));
    }
}

// Gravity has no moment about a vertical axis. The joint stays at its start, and is named.
TEST(Statics, NeutralJointsStayWhereTheyStart) {
  for (const bool is_flexible : {false, true})
    for (const double start : {0.0, 0.7}) {
      SceneBuilder b = pan_lift_elbow(0, is_flexible);
      b.scene.initial_joints.push_back({"pan", start, 0, {}});
      b.scene.initial_joints.push_back({"lift", 2.5, 0, {}});
      Simulation simulation(b.scene);
      const StaticResult result = simulation.solve_static(10);
      ASSERT_TRUE(result.converged) << to_string(result.reason);
      EXPECT_NEAR(simulation.position(0), start, 1e-9) << is_flexible;
      EXPECT_NEAR(std::abs(simulation.position(1)), kPi, kTolerance) << is_flexible;
      EXPECT_EQ(hold_of(simulation).free, std::vector<std::size_t>{0}) << is_flexible;
    }
}

// Compares with differences of the force. Their error is the third derivative, h^2 times the weight's effect, and
// round-off over h.
TEST(JointPotentials, CurvatureIsTheDerivativeOfTheForce) {
  for (const bool is_flexible : {false, true}) {
    SceneBuilder b = pan_lift_elbow(0.3, is_flexible);
    b.scene.initial_joints.push_back({"pan", 0.4, 0, {}});
    b.scene.initial_joints.push_back({"lift", 1.5, 0, {}});
    b.scene.initial_joints.push_back({"elbow", -0.8, 0, {}});
    const Simulation simulation(b.scene);
    StepSettings settings;
    settings.tolerance = 1e-12;
    JointPotentials potentials(model_of(simulation), exact_equilibrium(), settings);
    StepResult result;
    JointPotential at;
    at.state = state_of(simulation);
    ASSERT_TRUE(potentials.begin(at.state));
    ASSERT_TRUE(potentials.rest(at.state, 1, result));
    ASSERT_TRUE(potentials.look(at));
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 3; ++i) {
      JointPotential ahead, behind;
      ASSERT_TRUE(potentials.move(at, kStep * Eigen::Vector3d::Unit(i), ahead.state, result));
      ASSERT_TRUE(potentials.move(at, -kStep * Eigen::Vector3d::Unit(i), behind.state, result));
      ASSERT_TRUE(potentials.look(ahead) && potentials.look(behind));
      EXPECT_NEAR(potentials.ways(at.state, ahead.state)[i], kStep, 1e-12);
      const Eigen::Vector3d difference = (ahead.force - behind.force) / (2 * kStep);
      // The elements' test functions differ from the variation of their strains, which has an error of its own.
      const double own = is_flexible ? 1e-4 : 0;
      EXPECT_LT((difference - at.curvature.col(i)).norm(), potentials.reference() * (kStep * kStep + own + 1e-10));
    }
  }
}

// The same for the single degree of freedom of a loop: force and curvature under its constraints.
TEST(JointPotentials, CurvatureOfALoopIsTheDerivativeOfTheForce) {
  SceneBuilder b = slider_crank();
  b.scene.gravity = {0, -9.81, 0};
  const Simulation simulation(b.scene);
  StepSettings settings;
  settings.tolerance = 1e-12;
  JointPotentials potentials(model_of(simulation), exact_equilibrium(), settings);
  StepResult result;
  JointPotential at, ahead, behind;
  at.state = state_of(simulation);
  ASSERT_TRUE(potentials.begin(at.state));
  ASSERT_EQ(potentials.axes().size(), 1U);
  ASSERT_TRUE(potentials.rest(at.state, 1, result));
  ASSERT_TRUE(potentials.look(at));
  // dV/da of the crank's angle a, divided by the derivative of the chosen coordinate with respect to a.
  const SliderCrank crank(kAngle);
  const double by_angle = 9.81 * (kCrankMass * kCrankCentre * std::cos(kAngle) + kRodMass * crank.first(kRodCentre)[1]);
  const std::size_t chosen = potentials.axes()[0].coordinate;
  const double turn = chosen == 0 ? 1 : chosen == 1 ? crank.p1 - 1 : crank.first(kRod)[0];
  EXPECT_NEAR(at.force[0] * potentials.axes()[0].scale, by_angle / turn, 1e-10);
  constexpr double kStep = 1e-4;
  const Eigen::VectorXd step = Eigen::VectorXd::Constant(1, kStep);
  ASSERT_TRUE(potentials.move(at, step, ahead.state, result) && potentials.move(at, -step, behind.state, result));
  ASSERT_TRUE(potentials.look(ahead) && potentials.look(behind));
  // The third derivative is about the force over the square of the length scale, 0.2.
  EXPECT_NEAR((ahead.force[0] - behind.force[0]) / (2 * kStep), at.curvature(0, 0),
              100 * potentials.reference() * kStep * kStep + 1e-8);
}

}  // namespace
}  // namespace flexarm
