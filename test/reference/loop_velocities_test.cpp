// Tests loops of rigid links when scheme, step or joint velocities change during the motion: velocities must be
// corrected such that the loop stays closed. Also compares runs to an accuracy with the equation of a loop's single
// degree of freedom.
#include <cmath>

#include "flexarm/accuracy/accurate_run.h"
#include "math/pi.h"
#include "reference/dynamics_runs.h"
#include "reference/ode.h"
#include "reference/slider_crank.h"
#include "schemes/scheme.h"
#include "simulation/loop_velocities.h"
#include "support/closed_ring.h"

namespace flexarm::test {
namespace {

using Eigen::VectorXd;
using scene::JointKind;

// ---------------------------------------------------------------- scenes

double torque(double t) {
  return 4 * std::sin(3 * t) + 1;
}

/// The slider-crank of slider_crank(), driven by torque().
SceneBuilder driven_crank(const std::string& scheme = "auto") {
  SceneBuilder b = slider_crank(scheme);
  b.scene.efforts.push_back({"a", TimeFunction::parse("4*sin(3*t)+1"), {}});
  return b;
}

VectorXd driven_rates(double t, const VectorXd& y) {
  return crank_rates(y, torque(t));
}

/// Exact motion of the probes of driven_crank().
JudgedMotion exact_motion(double until, int intervals) {
  JudgedMotion motion(2);
  VectorXd y = Eigen::Vector2d(kAngle, 0);
  for (int i = 0; i <= intervals; ++i) {
    if (i > 0) y = solve_ode(driven_rates, until * (i - 1) / intervals, until * i / intervals, y);
    const SliderCrank s(y[0]);
    const Eigen::Vector2d pin = s.point(kRod), centre = s.point(kRodCentre);
    motion.add({{pin[0], 0, 0}, {centre[0], centre[1], 0}});
  }
  return motion;
}

/// Two blocks on separate rails along x, connected by a loop joint.
SceneBuilder coupled_blocks(double first, double second) {
  SceneBuilder b;
  b.body("first", first, {0, 0, 0}, 0.01 * Matrix3::Identity());
  b.body("second", second, {0, 0, 0}, 0.01 * Matrix3::Identity());
  b.joint("first", JointKind::Prismatic, "world", "first", {0, 0, 0}, {1, 0, 0});
  b.joint("second", JointKind::Prismatic, "world", "second", {0, 1, 0}, {1, 0, 0});
  close_loop(b, "bolt", JointKind::Spherical, "first", "second", {0, -0.5, 0});
  return b;
}

/// A spatial loop (RSSR): a crank about z, a rocker about x, and a rod between them on two ball joints.
SceneBuilder spatial_loop() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.body("crank", 1, {0.1, 0, 0}, 0.01 * Matrix3::Identity());
  b.body("rod", 0.6, {0.3, 0.1, 0.2}, Vector3(0.02, 0.03, 0.025).asDiagonal());
  b.body("rocker", 0.9, {0, 0, 0.25}, 0.02 * Matrix3::Identity());
  b.joint("a", JointKind::Continuous, "world", "crank", {0, 0, 0}, {0, 0.6, 0.8});
  b.joint("ball", JointKind::Spherical, "crank", "rod", {0.2, 0, 0});
  b.joint("c", JointKind::Continuous, "world", "rocker", {0.9, 0.3, 0}, {1, 0, 0});
  close_loop(b, "socket", JointKind::Universal, "rocker", "rod", {0.7, 0.3, 0.5}, {0, 1, 0}).axis2 = {0, 0, 1};
  return b;
}

double fastest(const Simulation& s) {
  double out = 0;
  for (const NodeState& node : state_of(s).nodes)
    out = std::max({out, node.velocity.norm(), node.angular_velocity.norm()});
  return out;
}

LoopOpening opening_of_velocities(const Simulation& s) {
  std::vector<NodePose> poses;
  std::vector<Vector6> velocities;
  for (const NodeState& node : state_of(s).nodes) {
    poses.push_back(node_pose(node));
    velocities.push_back(spatial_velocity(node));
  }
  return opening_of(model_of(s), poses, velocities);
}

// ---------------------------------------------------------------- velocities

// The correction with the least change of kinetic energy is that of an inelastic collision: momentum is conserved, and
// the loss is m1 m2 (v1 - v2)^2 / (2 (m1 + m2)).
TEST(LoopVelocities, AreThoseAfterAnInelasticBlow) {
  const double m1 = 2, m2 = 0.5, v1 = 3, v2 = -1;
  const Simulation simulation(coupled_blocks(m1, m2).scene);
  const Model& model = model_of(simulation);
  State state = state_of(simulation);
  const DegreesOfFreedom dof(model);
  const auto node_of = [&](const char* link) {
    for (const LinkFrame& frame : model.links)
      if (frame.name == link) return frame.frame.node;
    return -1;
  };
  state.nodes[node_of("first")].velocity = {v1, 0, 0};
  state.nodes[node_of("second")].velocity = {v2, 0, 0};
  const State closed = with_closed_loops(model, dof, state);
  const double together = (m1 * v1 + m2 * v2) / (m1 + m2);
  for (const char* link : {"first", "second"}) {
    const NodeState& node = closed.nodes[node_of(link)];
    EXPECT_LT((node.velocity - Vector3(together, 0, 0)).norm(), 1e-14 * v1) << link;
    EXPECT_LT(node.angular_velocity.norm(), 1e-14) << link;
  }
}

TEST(LoopVelocities, ThatAreClosedStayToTheBit) {
  SceneBuilder b = coupled_blocks(1, 2);
  initial_joint(b, "first", 0, 0.7);
  const Simulation simulation(b.scene);
  const State& state = state_of(simulation);
  const State closed = with_closed_loops(model_of(simulation), DegreesOfFreedom(model_of(simulation)), state);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) EXPECT_EQ(closed.nodes[i].velocity, state.nodes[i].velocity);
}

// A flat parallelogram. There, its constraint along the bars does not restrict velocities; near it, the constraint does
// so hardly. So no reasonable velocity correction can close an opening along the bars.
TEST(LoopVelocities, StayWithinReasonAtDeadPoints) {
  SceneBuilder b;
  b.body("crank", 1, {0.1, 0, 0.1}, 1e-2 * Matrix3::Identity());
  b.body("coupler", 0.5, {0.25, 0, 0}, 1e-2 * Matrix3::Identity());
  b.body("rocker", 0.5, {0, 0, -0.1}, 1e-2 * Matrix3::Identity());
  b.joint("crank", JointKind::Continuous, "world", "crank", {0, 0, 0}, kAcross);
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0, 0, 0.2}, kAcross);
  b.joint("hip", JointKind::Continuous, "coupler", "rocker", {0.6, 0, 0}, kAcross);
  close_loop(b, "foot", JointKind::Continuous, "world", "rocker", {0, 0, -0.2}, kAcross);
  for (const double off : {0.0, 1e-9, 1e-6, 1e-4, 1e-2}) {
    Simulation simulation(b.scene);
    const double angle = 0.5 * kPi - off;
    simulation.set_joint_state({{0, angle, 1.0}, {1, -angle, -1.0}, {2, angle, 1.0}});
    State state = state_of(simulation);
    constexpr double kOpens = 1e-4;
    state.nodes.back().velocity += kOpens * Vector3(1, 0, 1);
    const State closed = with_closed_loops(model_of(simulation), DegreesOfFreedom(model_of(simulation)), state);
    for (std::size_t i = 0; i < state.nodes.size(); ++i)
      EXPECT_LT((closed.nodes[i].velocity - state.nodes[i].velocity).norm(), 500 * kOpens) << off;
  }
}

/// Relative rate at which velocities open the loop, after `steps` steps to the same time.
double opening_after(const std::string& scheme, int steps) {
  SceneBuilder b = driven_crank();
  Simulation simulation(b.scene, options(scheme, 0.5 / steps, 1e-12));
  run(simulation, steps);
  return opening_of_velocities(simulation).rate / opening_of_velocities(simulation).fastest;
}

// joints.md 3.2: the rule for velocities does not satisfy the constraint. The loop opens by the second power of the
// step (also with em4), or by the first power with backward differences. Odd numbers of steps are used, since even
// numbers close the loop again.
TEST(LoopVelocities, OpenByTheOrderOfTheirRule) {
  for (const char* scheme : {"em", "m1", "edmc2", "newmark"}) {
    const double coarse = opening_after(scheme, 75), fine = opening_after(scheme, 225);
    EXPECT_NEAR(std::log(coarse / fine) / std::log(3.0), 2, 0.25) << scheme;
  }
  EXPECT_NEAR(std::log(opening_after("m2", 75) / opening_after("m2", 225)) / std::log(3.0), 1, 0.15);
}

/// Checks that the motion continues smoothly when a scheme or a step takes over from another one.
void expect_goes_on(const SceneBuilder& b, const std::string& before, const std::string& after, double factor) {
  SCOPED_TRACE(before + " to " + after + " by " + std::to_string(factor));
  Simulation from(b.scene, options(before, 0.01, 1e-10));
  run(from, 25);
  Simulation to(b.scene, options(after, 0.01 * factor, 1e-10));
  ASSERT_NO_THROW(to.take_over(from));
  const bool is_same = before == after && factor == 1;
  for (std::size_t i = 0; i < from.coordinate_names().size(); ++i)
    EXPECT_EQ(to.position(i), from.position(i)) << from.coordinate_names()[i];
  if (!is_same) {
    EXPECT_LT(opening_of_velocities(to).rate, 1e-12 * opening_of_velocities(to).fastest);
  }
  const double energy = from.energies().kinetic;
  EXPECT_NEAR(energy_account(to), energy_account(from), 1e-12 * (1 + energy));
  for (std::size_t i = 0; i < state_of(to).nodes.size(); ++i)  // velocities differ by an error of the scheme
    EXPECT_LT((state_of(to).nodes[i].velocity - state_of(from).nodes[i].velocity).norm(),
              (before == "m2" || before == "edmc1" ? 0.1 : 0.02) * fastest(from));
  const Vector3 linear = to.momentum(), angular = to.angular_momentum();
  const bool floats = b.scene.gravity.isZero(0) && from.find_coordinate("flight/rx");
  if (floats) {
    EXPECT_LT((linear - from.momentum()).norm(), 1e-12);
    EXPECT_LT((angular - from.angular_momentum()).norm(), 1e-12);
  }
  run(to, 10);
  EXPECT_NO_THROW(from.take_over(to));
  run(from, 5);
}

TEST(LoopVelocities, AnySchemeTakesOverFromAnyOther) {
  const std::vector<SceneBuilder> scenes = {driven_crank(), free_ring(JointKind::Universal), spatial_loop()};
  for (const SceneBuilder& b : scenes)
    for (const Scheme& before : schemes())
      for (const Scheme& after : schemes()) expect_goes_on(b, std::string(before.name), std::string(after.name), 1);
}

TEST(LoopVelocities, OtherStepsTakeOver) {
  for (const char* scheme : {"em", "em4", "edmc2", "newmark", "hht3"})
    for (const double factor : {1.0, 0.37, 0.01, 4.0}) expect_goes_on(driven_crank(), scheme, scheme, factor);
}

/// Error of the crank's angle at 1 s. The step lengths alternate; each holds for a twentieth of the time.
double error_in_steps(const std::vector<double>& lengths) {
  constexpr double kPart = 0.05;
  SceneBuilder b = driven_crank();
  Simulation simulation(b.scene, options("em", lengths[0], 1e-12));
  InvariantDrift drift(simulation);
  for (int part = 0; part < 20; ++part) {
    const double step = lengths[part % lengths.size()];
    simulation.set_step_size(step);
    run(simulation, static_cast<int>(std::lround(kPart / step)), [&] { drift.observe(); });
  }
  // Round-off of positions over the step is a velocity error with random sign. All speeds are about 1 here.
  const double shortest = *std::min_element(lengths.begin(), lengths.end());
  EXPECT_LT(drift.energy(), 1e-10 + 4 * kEpsilon / shortest * std::sqrt(1 / shortest));
  EXPECT_NEAR(simulation.time(), 1, 1e-10);
  return std::abs(simulation.position(0) - solve_ode(driven_rates, 0, 1, Eigen::Vector2d(kAngle, 0))[0]);
}

// Velocities that do not satisfy the constraint after an odd number of longer steps do not affect the shorter steps.
// The scheme keeps its energy, and the error is at most that of the longer steps.
TEST(LoopVelocities, LeftOpenDoNoHarmToOtherSteps) {
  const double longest = error_in_steps({0.01});
  EXPECT_GT(longest, 1e-5);
  for (const double shorter : {0.005, 0.001, 0.0001}) EXPECT_LT(error_in_steps({0.01, shorter}), longest) << shorter;
}

TEST(LoopVelocities, JointsOfAMovingLoopCanBeSet) {
  Simulation simulation(driven_crank().scene, options("em", 0.01));
  run(simulation, 25);
  ASSERT_GT(opening_of_velocities(simulation).rate, 2e-6 * opening_of_velocities(simulation).fastest)
      << "more than those may who set them";
  const double books = energy_account(simulation);
  // If positions are set to their present values, only the velocities change: the correction that closes the loop.
  std::vector<double> places;
  for (std::size_t i = 0; i < 3; ++i) places.push_back(simulation.position(i));
  ASSERT_NO_THROW(simulation.set_joint_state({{0, places[0], {}}, {1, places[1], {}}, {2, places[2], {}}}));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(simulation.position(i), places[i], 1e-15);
  EXPECT_LT(opening_of_velocities(simulation).rate, 1e-12 * opening_of_velocities(simulation).fastest);
  // First, velocities that satisfy the constraint; then one that does not.
  const SliderCrank s(simulation.position(0));
  const double rate = 2.5;
  ASSERT_NO_THROW(
      simulation.set_joint_state({{0, {}, rate}, {1, {}, (s.p1 - 1) * rate}, {2, {}, s.first(kRod)[0] * rate}}));
  EXPECT_NEAR(energy_account(simulation), books, 1e-12);
  run(simulation, 1);
  EXPECT_THROW(simulation.set_joint_state({{0, {}, 5.0}}), std::invalid_argument);
  EXPECT_THROW(simulation.set_joint_state({{0, 0.1, {}}}), std::invalid_argument);
  run(simulation, 20);
  EXPECT_NEAR(energy_account(simulation), books, 1e-9);
}

TEST(LoopVelocities, SnapshotsComeBackToTheBit) {
  for (const char* scheme : {"em", "em4", "newmark"}) {
    SimulationOptions exact = options(scheme, 0.01);
    exact.reuse_factorisation = false;
    Simulation simulation(driven_crank().scene, exact);
    run(simulation, 25);
    const Snapshot snapshot = simulation.snapshot();
    run(simulation, 20);
    const double place = simulation.position(0), energy = simulation.energies().kinetic;
    simulation.restore(snapshot);
    run(simulation, 20);
    EXPECT_EQ(simulation.position(0), place) << scheme;
    EXPECT_EQ(simulation.energies().kinetic, energy) << scheme;
  }
}

// ---------------------------------------------------------------- accuracy

void expect_accuracy(const std::string& scheme, double accuracy) {
  SCOPED_TRACE(scheme + " to " + std::to_string(accuracy));
  constexpr double kUntil = 2;
  constexpr int kIntervals = 100;
  static const JudgedMotion exact = exact_motion(kUntil, kIntervals);
  Simulation simulation(driven_crank(scheme).scene);
  RunWatcher nobody;
  const AccurateRun run = run_to_accuracy(simulation, {accuracy, kUntil, kIntervals}, nobody);
  EXPECT_EQ(run.end, AccurateRun::End::Met);
  EXPECT_LE(motion_error(run.motion, exact, run.scale), accuracy);
  EXPECT_NEAR(simulation.time(), kUntil, 1e-12);
  // The simulation continues from there with its own scheme.
  const Eigen::Vector2d end = exact.points[1].back().head<2>();
  EXPECT_LE((simulation.probe_pose(1).position.head<2>() - end).norm(), 4 * accuracy * run.scale);
  test::run(simulation, 5);
}

TEST(LoopAccuracy, OfASliderCrankIsWhatIsAskedFor) {
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) expect_accuracy("auto", accuracy);
}

// Left out is Newmark's rule with gamma = 1/2, whose multipliers grow without end (theory/joints.md, "Closed loops").
TEST(LoopAccuracy, IsMetByOtherSchemes) {
  for (const char* scheme : {"em", "em0", "em_symmetric", "em4", "edmc2", "m1", "std", "hht1", "hht3"})
    expect_accuracy(scheme, 1e-3);
  for (const char* scheme : {"em", "em4", "edmc2"}) expect_accuracy(scheme, 1e-4);
}

}  // namespace
}  // namespace flexarm::test
