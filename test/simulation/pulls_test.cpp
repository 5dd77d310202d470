// Tests pulls, i.e. springs and dampers from outside on points of links, and the forces that are offered to displays.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "flexarm/simulation/checkpoint.h"
#include "simulation/body_with_beam.h"
#include "simulation/same_bits.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

const Vector3 kPoint(0.5, 0.1, -0.2), kTarget(0.2, 0.6, 0.4);
constexpr double kStiffness = 40, kDamping = 3, kMass = 2, kStep = 0.01;

/// A mass on a straight rail along y.
SceneBuilder slider() {
  SceneBuilder b;
  b.scene.integrator.step = kStep;
  b.body("mass", kMass, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "mass", Vector3::Zero(), Vector3::UnitY());
  return b;
}

AppliedWrench pull_on(const Simulation& simulation, const std::string& link, double damping) {
  return {link_of(simulation, link), kPoint, {}, false, {kTarget, kStiffness, damping}};
}

class Pulls : public ::testing::TestWithParam<std::string> {
 protected:
  static Simulation simulated(const SceneBuilder& builder) { return Simulation(builder.scene, options(GetParam())); }
};

// Without a damper, the work of the pull equals the energy that the spring loses.
TEST_P(Pulls, DoTheWorkThatTheSpringLoses) {
  Simulation simulation = simulated(body_with_beam());
  simulation.apply_wrenches({pull_on(simulation, "body", 0)});
  const auto potential = [&] {
    const Pose body = simulation.link_pose(link_of(simulation, "body"));
    return 0.5 * kStiffness * (kTarget - body * kPoint).squaredNorm();
  };
  const double start = potential();
  double moved = 0;
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    moved = std::max(moved, start - potential());
  }
  EXPECT_GT(moved, 0.3 * start);
  // The work is the mean force times the displacement of the point. This is exact in any scheme, up to the round-off of
  // 200 steps.
  EXPECT_NEAR(simulation.energies().work, start - potential(), 1e-10 * start);
}

// With a damper, the motion ends with the point at the target, if the mechanism allows it.
TEST_P(Pulls, ComeToRestAtTheTarget) {
  Simulation simulation = simulated(slider());
  simulation.apply_wrenches({pull_on(simulation, "mass", kDamping)});
  // The motion decays with c/2m = 0.75/s: after 30 s, to 2e-10.
  for (int n = 0; n < 3000; ++n) ASSERT_TRUE(simulation.step().converged);
  EXPECT_NEAR(simulation.position(0), kTarget.y() - kPoint.y(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Schemes, Pulls, ::testing::Values("em", "em0", "std", "edmc2", "m1", "newmark"));

// The force is the mean of both ends of the step. So the oscillation is that of the midpoint rule, with 2 atan(omega h
// / 2) per step.
TEST(Pull, OscillatesAsTheMidpointRuleSays) {
  Simulation simulation(slider().scene);
  simulation.apply_wrenches({pull_on(simulation, "mass", 0)});
  const double angle = 2 * std::atan(0.5 * kStep * std::sqrt(kStiffness / kMass)), way = kTarget.y() - kPoint.y();
  for (int n = 1; n <= 500; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged);
    ASSERT_LE(result.iterations, 2);  // the problem is linear
    ASSERT_NEAR(simulation.position(0), way * (1 - std::cos(n * angle)), 1e-10);
  }
}

// The damper acts in backward sub-steps, too: the motion y'' = -2 d y' - w^2 (y - way) is of fourth order.
TEST(Pull, WithADamperIsOfTheOrderOfCompositions) {
  const double way = kTarget.y() - kPoint.y(), d = 0.5 * kDamping / kMass, w = std::sqrt(kStiffness / kMass - d * d);
  const auto error = [&](double step) {
    SceneBuilder b = slider();
    b.scene.integrator.scheme = "em4";
    b.scene.integrator.step = step;
    b.scene.integrator.tolerance = 1e-12;
    Simulation simulation(b.scene);
    simulation.apply_wrenches({pull_on(simulation, "mass", kDamping)});
    while (simulation.time() < 1 - 1e-9) EXPECT_TRUE(simulation.step().converged);
    return std::abs(simulation.position(0) - way * (1 - std::exp(-d) * (std::cos(w) + d / w * std::sin(w))));
  };
  EXPECT_NEAR(std::log2(error(0.1) / error(0.05)), 4, 0.3);
}

// The tangent of the pull is exact, so Newton's method converges as fast as without the pull.
TEST(Pull, CostsNoIterations) {
  Simulation simulation(body_with_beam().scene, full_newton());
  AppliedWrench pull = pull_on(simulation, "body", 50);
  pull.pull.stiffness = 5000;
  simulation.apply_wrenches({pull});
  for (int n = 0; n < 100; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged);
    EXPECT_LE(result.iterations, 5);
  }
}

// An explicit force of this stiffness and damping would be unstable. Here the mass follows within one step.
TEST(Pull, IsStableHoweverStiff) {
  Simulation simulation(slider().scene);
  AppliedWrench pull = pull_on(simulation, "mass", 1e9);
  pull.pull.stiffness = 1e9;
  simulation.apply_wrenches({pull});
  for (int n = 0; n < 2000; ++n) ASSERT_TRUE(simulation.step().converged);
  EXPECT_NEAR(simulation.position(0), kTarget.y() - kPoint.y(), 1e-6);
}

TEST(Pull, HoldsInEquilibrium) {
  SceneBuilder b = slider();
  b.scene.springs.push_back({"rail", 60, 0});
  Simulation simulation(b.scene);
  simulation.apply_wrenches({pull_on(simulation, "mass", kDamping)});
  ASSERT_TRUE(simulation.solve_static(2).converged);
  EXPECT_NEAR(simulation.position(0), kStiffness * (kTarget.y() - kPoint.y()) / (kStiffness + 60), 1e-10);
}

TEST(Pull, IsKeptInTheState) {
  const std::string path = ::testing::TempDir() + "flexarm_pulls_test.state";
  const SimulationOptions options = full_newton();
  Simulation simulation(body_with_beam().scene, options), resumed(body_with_beam().scene, options);
  simulation.apply_wrenches({pull_on(simulation, "body", kDamping)});
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
  write_checkpoint(simulation, path);
  read_checkpoint(resumed, path);
  for (Simulation* each : {&simulation, &resumed})
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(each->step().converged);
  EXPECT_TRUE(same_bits(state_of(resumed), state_of(simulation)));
  std::remove(path.c_str());
}

TEST(Pull, ThatCannotActIsRefused) {
  Simulation simulation(body_with_beam().scene);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    AppliedWrench pull = pull_on(simulation, "body", 0);
    pull.pull.stiffness = bad;
    EXPECT_THROW(simulation.apply_wrenches({pull}), std::invalid_argument);
    pull = pull_on(simulation, "body", bad);
    EXPECT_THROW(simulation.apply_wrenches({pull}), std::invalid_argument);
  }
  AppliedWrench pull = pull_on(simulation, "body", 0);
  pull.pull.target.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(simulation.apply_wrenches({pull}), std::invalid_argument);
  Simulation interpolating(body_with_beam().scene, options("hht2"));
  EXPECT_THROW(interpolating.apply_wrenches({pull_on(interpolating, "body", 0)}), std::invalid_argument);
  EXPECT_TRUE(state_of(simulation).wrenches.empty());
}

// ---------------------------------------------------------------- wrenches that displays show

TEST(ShownWrenches, OutsideOnesAreThoseOfSceneAndUser) {
  SceneBuilder b = slider();
  b.load("mass", {0, 0, 0.1}, {0, 3, 0}, {1, 0, 0}, "2*t");
  Simulation simulation(b.scene);
  simulation.apply_wrenches({pull_on(simulation, "mass", kDamping)});
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(simulation.step().converged);
  std::vector<ActingWrench> wrenches;
  simulation.outside_wrenches(wrenches);
  ASSERT_EQ(wrenches.size(), 2u);
  const double y = simulation.position(0), time = simulation.time();
  EXPECT_LT((wrenches[0].position - Vector3(0, y, 0.1)).norm(), 1e-12);
  EXPECT_LT((wrenches[0].wrench.force - 2 * time * Vector3(0, 3, 0)).norm(), 1e-9);
  EXPECT_LT((wrenches[0].wrench.moment - 2 * time * Vector3::UnitX()).norm(), 1e-9);
  const Vector3 place = kPoint + y * Vector3::UnitY();
  EXPECT_LT((wrenches[1].position - place).norm(), 1e-12);
  const Vector3 force = kStiffness * (kTarget - place) - kDamping * simulation.velocity(0) * Vector3::UnitY();
  EXPECT_LT((wrenches[1].wrench.force - force).norm(), 1e-9);
}

TEST(ShownWrenches, EffortsActAlongTheirAxes) {
  SceneBuilder b;
  b.body("arm", 1, {0.3, 0, 0}, 0.1 * Matrix3::Identity());
  b.body("slide", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "world", "arm", {0, 0, 2}, Vector3::UnitZ());
  b.joint("rail", JointKind::Prismatic, "arm", "slide", {1, 0, 0}, Vector3::UnitX());
  b.scene.initial_joints.push_back({"hinge", M_PI / 2, 0, {}});
  b.scene.initial_joints.push_back({"rail", 0.25, 0, {}});
  Simulation simulation(b.scene);
  simulation.command_effort(0, 4);
  simulation.command_effort(1, -2);
  ASSERT_TRUE(simulation.step().converged);
  std::vector<ActingWrench> wrenches;
  simulation.effort_wrenches(wrenches);
  ASSERT_EQ(wrenches.size(), 2u);
  const Pose arm = simulation.link_pose(link_of(simulation, "arm"));
  EXPECT_LT((wrenches[0].position - Vector3(0, 0, 2)).norm(), 1e-12);
  EXPECT_LT((wrenches[0].wrench.moment - 4 * Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_TRUE(wrenches[0].wrench.force.isZero(0));
  EXPECT_LT((wrenches[1].wrench.force + 2 * (arm.orientation * Vector3::UnitX())).norm(), 1e-12);
  EXPECT_LT((wrenches[1].position - simulation.link_pose(link_of(simulation, "slide")).position).norm(), 1e-12);
}

TEST(ShownWrenches, OfSensorsAreFreeOfErrors) {
  SceneBuilder b = body_with_beam();
  b.scene.gravity = {0, 0, -9.81};
  b.sensor("cell", scene::SensorKind::Wrench, "beam", {0, 0.2, 0});
  b.scene.sensors.back().bias = {1};
  b.sensor("eye", scene::SensorKind::Pose, "beam");
  Simulation simulation(b.scene);
  for (int n = 0; n < 50; ++n) ASSERT_TRUE(simulation.step().converged);
  const ActingWrench wrench = simulation.sensed_wrench(0);
  const Pose beam = simulation.link_pose(link_of(simulation, "beam"));
  EXPECT_LT((wrench.position - beam * Vector3(0, 0.2, 0)).norm(), 1e-12);
  const Vector3 force = beam.orientation.conjugate() * wrench.wrench.force;
  const Vector3 moment = beam.orientation.conjugate() * wrench.wrench.moment;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(simulation.sample(0).values[k], force[k] + 1, 1e-9);
    EXPECT_NEAR(simulation.sample(0).values[3 + k], moment[k] + 1, 1e-9);
  }
  EXPECT_THROW(simulation.sensed_wrench(1), std::invalid_argument);
}

TEST(Shown, MassAndFixedLinks) {
  const SceneBuilder b = body_with_beam();
  const Simulation simulation(b.scene);
  EXPECT_NEAR(simulation.mass(), 1 + 0.5, 1e-12);
  EXPECT_TRUE(simulation.is_fixed_to_world(link_of(simulation, "world")));
  EXPECT_FALSE(simulation.is_fixed_to_world(link_of(simulation, "body")));
}

// The sections are those of the undeformed beam in its link's frame, wherever the link starts.
TEST(Shown, UndeformedSections) {
  SceneBuilder b = body_with_beam();
  b.scene.initial_joints.push_back({"ball/rz", 0.7, 0, {}});
  Simulation simulation(b.scene);
  const std::size_t beam = link_of(simulation, "beam");
  for (int n = 0; n < 20; ++n) ASSERT_TRUE(simulation.step().converged);
  const std::vector<Pose> sections = simulation.undeformed_sections(beam, 1);
  ASSERT_EQ(sections.size(), 17u);  // 9 nodes
  for (std::size_t k = 0; k < sections.size(); ++k) {
    EXPECT_LT((sections[k].position - Vector3(k / 16.0, 0, 0)).norm(), 1e-12);
    EXPECT_LT((sections[k].orientation * Vector3::UnitX() - Vector3::UnitX()).norm(), 1e-12);
  }
  EXPECT_TRUE(simulation.undeformed_sections(link_of(simulation, "body"), 1).empty());
}

}  // namespace
}  // namespace flexarm::test
