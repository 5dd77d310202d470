// Tests set_joint_state(), which gives joint coordinates new positions or velocities during a run.
#include <cmath>
#include <limits>

#include "schemes/scheme.h"
#include "simulation/same_bits.h"
#include "support/loops.h"
#include "support/refusal.h"
#include "support/runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kRoundOff = 1e-13;           ///< of numbers about 1, after some hundred operations
constexpr double kStep = 0.002, kTime = 0.2;  // [s]
/// Difference of two motions over a hundred steps, whose starts differ by round-off. Newton's method makes each step
/// until the residual is below its tolerance of 1e-11; after that comes a last update, which converges quadratically.
constexpr double kSameMotion = 1e-10;
/// The Newmark family computes accelerations at the start from a step that is shorter by the factor 1e-2. Their error
/// is round-off over the square of this step; the rest is the distance that it makes over kTime.
constexpr double kSameAcceleration = 1e-16 / (1e-4 * kStep * kStep) * kTime * kTime / 2;
/// A scheme's own velocities fit to the joints with an error of second order: h^2/12 times third derivatives. These are
/// estimated for an arm that falls and swings at 2 Hz [m/s].
constexpr double kUnfitVelocity = kStep * kStep / 12 * 10 * 4 * 4 * M_PI * M_PI;

/// A mechanism of a shoulder with elastic gear and servo, a flexible arm, an elbow that a slider mimics, a ball joint,
/// and a free body.
SceneBuilder arm() {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = 1e-11;
  b.scene.integrator.step = kStep;
  const Matrix3 inertia = Vector3(0.02, 0.03, 0.025).asDiagonal();
  b.body("upper", 1, {0.2, 0, 0}, inertia);
  b.beam("forearm", {{0.6, 0, 0}}, section(2e4, 1e4, 150, 200, 0.5, 0.02, 0.01), 2, 2).stiffness_proportional_damping =
      1e-3;
  b.body("slider", 0.3, {0, 0, 0}, 0.1 * inertia);
  b.body("ball", 0.5, {0, 0, -0.1}, 0.1 * inertia);
  b.body("satellite", 2, {0.1, 0, 0}, inertia);
  b.joint("shoulder", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("elbow", JointKind::Revolute, "upper", "forearm", {0.4, 0, 0}, {0, 1, 0});
  b.joint("slide", JointKind::Prismatic, "upper", "slider", {0.1, 0.1, 0}, {1, 0, 0}).mimic =
      scene::Mimic{"elbow", 0.1, 0.02};
  b.joint("wrist", JointKind::Spherical, "forearm", "ball", {0.6, 0, 0});
  b.joint("flight", JointKind::Floating, "world", "satellite", {0, 2, 0});
  scene::DriveDescription& drive = b.drive("shoulder", 50, 1e-5);
  drive.stiffness = 2000;
  drive.damping = 1;
  b.servo("shoulder", 300, 10, 50).set_point = TimeFunction(0.2);
  return b;
}

struct Given {
  const char* coordinate;
  double position, velocity;
};
constexpr Given kElsewhere[] = {{"shoulder", 0.4, -0.3}, {"elbow", 0.7, 1.2},   {"wrist/rx", 0.2, 0.5},
                                {"wrist/rz", -0.3, 0.1}, {"flight/y", 0.4, -1}, {"flight/rz", 2.5, 3}};

std::vector<CoordinateState> given(const Simulation& simulation) {
  std::vector<CoordinateState> out;
  for (const Given& wanted : kElsewhere)
    out.push_back({*simulation.find_coordinate(wanted.coordinate), wanted.position, wanted.velocity});
  return out;
}

void run_for(Simulation& simulation, double seconds) {
  for (int i = static_cast<int>(std::lround(seconds / kStep)); i > 0; --i) ASSERT_TRUE(simulation.step().converged);
}

void expect_same_motion(const Simulation& a, const Simulation& b, double tolerance, const std::string& what) {
  for (std::size_t i = 0; i < a.coordinate_names().size(); ++i) {
    EXPECT_NEAR(a.position(i), b.position(i), tolerance) << what << ": " << a.coordinate_names()[i];
  }
  const State &x = state_of(a), &y = state_of(b);
  for (std::size_t i = 0; i < x.nodes.size(); ++i) {
    EXPECT_LT((x.nodes[i].position - y.nodes[i].position).norm(), tolerance) << what << ": node " << i;
    EXPECT_LT(x.nodes[i].orientation.angularDistance(y.nodes[i].orientation), 4 * tolerance) << what << ": node " << i;
  }
}

TEST(JointState, WhatIsSetGoesOnAsASceneThatStartsThere) {
  for (const char* scheme : {"em", "em0", "m1", "m2", "edmc2", "std", "newmark", "hht1", "hht3", "em4"}) {
    SceneBuilder b = arm();
    b.scene.integrator.scheme = scheme;
    Simulation moved(b.scene);
    moved.set_joint_state(given(moved));
    for (const Given& wanted : kElsewhere)
      b.scene.initial_joints.push_back({wanted.coordinate, wanted.position, wanted.velocity, {}});
    Simulation started(b.scene);
    expect_same_motion(moved, started, kRoundOff, scheme);
    for (std::size_t i = 0; i < moved.coordinate_names().size(); ++i)
      EXPECT_NEAR(moved.velocity(i), started.velocity(i), 10 * kRoundOff) << scheme;
    run_for(moved, kTime);
    run_for(started, kTime);
    const bool has_accelerations = !find_scheme(scheme)->is_incremental();
    expect_same_motion(moved, started, has_accelerations ? kSameAcceleration : kSameMotion, scheme);
  }
}

TEST(JointState, WhatIsNotNamedStaysAsItIs) {
  SceneBuilder b = arm();
  Simulation simulation(b.scene);
  run_for(simulation, kTime);
  const State before = state_of(simulation);
  const double energy = simulation.energies().total();
  const double energy_scale = 4.6 * 4;  // kinetic energy of bodies of 4.6 kg in all, at up to 4 m/s
  simulation.set_joint_state({});
  const State& after = state_of(simulation);
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    EXPECT_LT((before.nodes[i].position - after.nodes[i].position).norm(), kRoundOff);
    EXPECT_LT((before.nodes[i].velocity - after.nodes[i].velocity).norm(), kUnfitVelocity);
  }
  EXPECT_NEAR(simulation.energies().total(), energy, energy_scale * kUnfitVelocity);
  EXPECT_EQ(before.time, after.time);
  EXPECT_EQ(before.steps, after.steps);
  EXPECT_EQ(before.actuators[0].servo.integral, after.actuators[0].servo.integral);
}

TEST(JointState, StrainsAndTwistsOfGearsGoWithWhatIsMoved) {
  Simulation simulation(arm().scene);
  simulation.command_set_point(0, 0.35);
  run_for(simulation, kTime);
  const std::size_t elbow = *simulation.find_coordinate("elbow"), forearm = 2;
  ASSERT_EQ(simulation.link_names()[forearm], "forearm");
  const BeamPoint before = simulation.section(forearm, 0.25);
  const ActuatorState rotor = state_of(simulation).actuators[0];
  const double time = simulation.time(), slack = rotor.angle - simulation.position(0),
               books = energy_account(simulation);
  simulation.set_joint_state({{0, -0.5, {}}, {elbow, 0.9, 0.0}});
  const BeamPoint after = simulation.section(forearm, 0.25);
  EXPECT_GT(before.strain.norm(), 1e-4);
  EXPECT_LT((before.strain - after.strain).norm(), kRoundOff);
  EXPECT_EQ(simulation.position(0), -0.5);
  EXPECT_EQ(simulation.position(elbow), 0.9);
  EXPECT_NEAR(state_of(simulation).actuators[0].angle - simulation.position(0), slack, kRoundOff);
  EXPECT_EQ(state_of(simulation).actuators[0].servo.set_point, 0.35);
  EXPECT_EQ(simulation.position(*simulation.find_coordinate("slide")), 0.02 + 0.1 * 0.9);
  EXPECT_EQ(simulation.time(), time);
  EXPECT_NEAR(energy_account(simulation), books, kRoundOff * (1 + std::abs(books)));
  run_for(simulation, kTime);
  EXPECT_NEAR(energy_account(simulation), books, 1e-9 * (1 + std::abs(books)));  // the error of Newton's tolerance
}

TEST(JointState, WhatCannotBeSetIsRefusedAndChangesNothing) {
  SceneBuilder b = arm();
  b.scene.joints[1].limits = scene::JointLimits{-1, 1};
  b.scene.motions.push_back({"flight/x", TimeFunction(0.0), {}});
  Simulation simulation(b.scene);
  run_for(simulation, 5 * kStep);
  const State before = state_of(simulation);
  const auto coordinate = [&](const char* name) { return *simulation.find_coordinate(name); };
  const auto refused = [&](const std::vector<CoordinateState>& wanted, const char* told) {
    expect_contains(refusal<std::invalid_argument>([&] { simulation.set_joint_state(wanted); }), told);
    EXPECT_TRUE(same_bits(before, state_of(simulation)));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused({{0, nan, {}}}, "'shoulder' needs finite");
  refused({{0, 1, {}}, {coordinate("wrist/ry"), {}, 1 / 0.0}}, "'wrist/ry' needs finite");
  refused({{coordinate("elbow"), 1.1, {}}}, "'elbow' cannot be set to 1.1: its limits are -1 to 1");
  refused({{0, 0.1, {}}, {0, {}, 1.0}}, "'shoulder' is named twice");
  refused({{coordinate("slide"), 0.1, {}}}, "follows 'elbow'");
  refused({{coordinate("flight/x"), 0.1, {}}}, "prescribed");
  EXPECT_THROW(simulation.set_joint_state({{1000, 0.1, {}}}), std::out_of_range);
}

// ---------------------------------------------------------------- closed loops

/// A parallelogram of rigid links, optionally with a flexible rocker.
Simulation parallelogram(bool is_flexible) {
  SceneBuilder b;
  b.body("crank", 1, {0, 0, 0.1}, 1e-3 * Matrix3::Identity());
  b.body("coupler", 0.5, {0.25, 0, 0}, 4e-3 * Matrix3::Identity());
  if (is_flexible)
    b.beam("rocker", {{0, 0, -0.2}}, section(2e5, 1e5, 30, 40, 0.8, 2e-4, 1e-4), 2, 2);
  else
    b.body("rocker", 0.5, {0, 0, -0.1}, 1e-3 * Matrix3::Identity());
  b.joint("crank", JointKind::Continuous, "world", "crank", {0, 0, 0}, {0, 1, 0});
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0, 0, 0.2}, {0, 1, 0});
  b.joint("hip", JointKind::Continuous, "coupler", "rocker", {0.6, 0, 0}, {0, 1, 0});
  close_loop(b, "foot", JointKind::Continuous, "world", "rocker", {0, 0, -0.2}, {0, 1, 0});
  return Simulation(b.scene);
}

TEST(JointState, LoopsStayClosedOrAreRefused) {
  for (const bool is_flexible : {false, true}) {
    Simulation simulation = parallelogram(is_flexible);
    EXPECT_THROW(simulation.set_joint_state({{0, 0.3, {}}}), std::invalid_argument);
    std::vector<CoordinateState> wanted = {{0, 0.3, 1.0}, {1, -0.3, -1.0}, {2, 0.3, 1.0}};
    if (is_flexible) wanted.push_back({*simulation.find_coordinate("foot"), 0.3, 1.0});
    simulation.set_joint_state(wanted);
    const double books = energy_account(simulation);
    run_for(simulation, kTime);
    EXPECT_NEAR(energy_account(simulation), books, 1e-9) << is_flexible;  // no loop was opened, nothing is strained
    EXPECT_NEAR(simulation.position(1), -simulation.position(0), is_flexible ? 1e-3 : 1e-7);
    if (is_flexible) continue;
    EXPECT_THROW(simulation.set_joint_state({{0, {}, 5.0}}), std::invalid_argument);
  }
}

/// A rotor under the Newmark family, which computes the accelerations at the start from a step of 1 %, here 1e-5 s. At
/// 1e6 rad/s the rotor turns further in it than a step allows, and halving is switched off.
scene::SceneDescription rotor_at(double speed) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"shaft", 0, speed, {}});
  b.scene.integrator.scheme = "newmark";
  b.scene.integrator.gamma = 0.6;
  b.scene.integrator.step = 1e-3;
  b.scene.integrator.max_halvings = 0;
  return b.scene;
}

TEST(Start, WarnsWhereAccelerationsCannotBeFound) {
  EXPECT_TRUE(Simulation(rotor_at(1)).start_warnings().empty());
  const Simulation racing(rotor_at(1e6));
  ASSERT_EQ(racing.start_warnings().size(), 1u);
  const std::string text = racing.start_warnings()[0].text();
  EXPECT_NE(text.find("warning: start: has zero accelerations"), std::string::npos) << text;
  EXPECT_NE(text.find("cannot be found: "), std::string::npos) << "the reason: " << text;
}

/// Without any damping, Newmark's rule with gamma 0.5 makes a double pendulum that turns at 3 rad/s stand still after
/// four seconds. So there is a warning.
TEST(Start, WarnsOfUndampedAccelerationsAcrossJoints) {
  scene::SceneDescription scene = rotor_at(1);
  for (const double gamma : {0.5, 0.51}) {
    scene.integrator.gamma = gamma;
    const scene::Diagnostics warnings = Simulation(scene).start_warnings();
    ASSERT_EQ(warnings.size(), gamma == 0.5) << gamma;
    if (gamma == 0.5) {
      EXPECT_NE(warnings[0].text().find("'newmark' with gamma 0.5"), std::string::npos);
    }
  }
  for (const char* scheme : {"em", "hht2", "m1"}) {
    scene.integrator = {};
    scene.integrator.scheme = scheme;
    EXPECT_TRUE(Simulation(scene).start_warnings().empty()) << scheme;
  }
  SceneBuilder flying;
  flying.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  flying.joint("flight", JointKind::Floating, "world", "rotor");
  flying.scene.integrator.scheme = "newmark";
  EXPECT_TRUE(Simulation(flying.scene).start_warnings().empty()) << "nothing holds it";
}

TEST(JointState, IsRefusedWhereAccelerationsCannotBeFound) {
  Simulation simulation(rotor_at(1));
  ASSERT_TRUE(simulation.step().converged);
  const double position = simulation.position(0), velocity = simulation.velocity(0);
  EXPECT_THROW(simulation.set_joint_state({{0, std::nullopt, 1e6}}), std::invalid_argument);
  EXPECT_EQ(simulation.position(0), position);
  EXPECT_EQ(simulation.velocity(0), velocity);
  EXPECT_TRUE(simulation.step().converged);
}

}  // namespace
}  // namespace flexarm::test
