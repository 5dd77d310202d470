// Tests the façade Simulation: names, coordinates, frames, observables, errors.
#include <cmath>
#include <stdexcept>
#include <string>

#include "math/pi.h"
#include "schemes/scheme.h"
#include "simulation/everything_scene.h"
#include "support/refusal.h"
#include "support/runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Two rigid links and a flexible one, connected by a hinge about z, a rail along x, and a ball joint.
SceneBuilder small_arm() {
  SceneBuilder b;
  b.body("base", 2, {0, 0, 0.1}, Matrix3::Identity());
  const scene::GeometricSection rod{scene::Circle{0.02}, scene::Material{7e10, 0.3, 2700}};
  b.beam("boom", {{1, 0, 0}}, rod, 2, 2);
  b.body("tool", 0.3, {0, 0, 0.1}, 0.01 * Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "world", "base", {0, 0, 0.5}, {0, 0, 1}).effort_limit = 3;
  b.joint("rail", JointKind::Prismatic, "base", "boom", {0.2, 0, 0}, {1, 0, 0});
  b.joint("ball", JointKind::Spherical, "boom", "tool", {1, 0, 0});
  b.scene.integrator.step = 0.002;
  return b;
}

class SmallArm : public ::testing::Test {
 protected:
  SmallArm() {
    SceneBuilder b = small_arm();
    b.scene.initial_joints.push_back({"hinge", kPi / 2, 0.5, {}});
    b.scene.initial_joints.push_back({"rail", 0.1, -0.2, {}});
    b.scene.initial_joints.push_back({"ball/rz", 0.3, 0, {}});
    b.probe("tip", "boom", {1, 0, 0});
    b.probe("tool", "tool", {0, 0, 0.2});
    scene_ = b.scene;
  }
  scene::SceneDescription scene_;
};

TEST_F(SmallArm, NamesItsCoordinatesAndLinks) {
  const Simulation s(scene_);
  EXPECT_EQ(s.coordinate_names(), (std::vector<std::string>{"hinge", "rail", "ball/rx", "ball/ry", "ball/rz"}));
  EXPECT_EQ(s.link_names(), (std::vector<std::string>{"world", "base", "boom", "tool"}));
  EXPECT_EQ(s.find_coordinate("ball/ry"), 3u);
  EXPECT_FALSE(s.find_coordinate("ball").has_value());
  EXPECT_FALSE(s.is_flexible(0));
  EXPECT_TRUE(s.is_flexible(2));
  EXPECT_DOUBLE_EQ(s.beam_radius(2), 0.02);
  EXPECT_EQ(s.scheme(), "em");
  EXPECT_DOUBLE_EQ(s.step_size(), 0.002);
  // Unknowns: hinge 1, rail 1, four free nodes of the boom 6 each, ball 3.
  EXPECT_EQ(s.degrees_of_freedom(), 1u + 1 + 4 * 6 + 3);
}

TEST_F(SmallArm, StartsWhereTheSceneSays) {
  const Simulation s(scene_);
  EXPECT_DOUBLE_EQ(s.position(0), kPi / 2);
  EXPECT_DOUBLE_EQ(s.position(1), 0.1);
  EXPECT_NEAR(s.position(4), 0.3, 1e-15);
  EXPECT_NEAR(s.velocity(0), 0.5, 1e-14);
  EXPECT_NEAR(s.velocity(1), -0.2, 1e-14);
  EXPECT_LT((s.link_pose(2).position - Vector3(0, 0.3, 0.5)).norm(), 1e-15);
  EXPECT_LT((s.tip_pose(2).position - Vector3(0, 1.3, 0.5)).norm(), 1e-15);
  const Quaternion quarter(Eigen::AngleAxisd(kPi / 2, Vector3::UnitZ()));
  EXPECT_LT(s.link_pose(2).orientation.angularDistance(quarter), 1e-7);
  EXPECT_LT(s.tip_pose(2).orientation.angularDistance(quarter), 1e-7) << "axes as the link's";
  EXPECT_LT(s.link_pose(3).orientation.angularDistance(quarter * Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitZ()))),
            1e-7);
  // v = w x r, plus the rate along the rotated x axis.
  EXPECT_LT((s.probe(0).velocity - Vector3(-0.5 * 1.3, -0.2, 0)).norm(), 1e-13);
  EXPECT_LT((s.probe(1).pose.position - Vector3(0, 1.3, 0.7)).norm(), 1e-14);
}

// The secant over a step differs from the mean of the velocities at both ends by at most the changes between the last
// secants. These changes are small against the velocity itself.
TEST_F(SmallArm, ProbeVelocityIsTheRateOfItsPosition) {
  for (const Scheme& scheme : schemes()) {
    const SimulationOptions options = test::options(std::string(scheme.name), 1e-4);
    for (const std::size_t probe : {0, 1}) {
      Simulation s(scene_, options);
      s.command_effort(0, 2);
      std::vector<ProbeState> states;
      std::vector<Vector3> secants;
      for (int n = 0; n < 50; ++n) {
        ASSERT_TRUE(s.step().converged);
        states.push_back(s.probe(probe));
        if (n > 0) secants.push_back((states[n].pose.position - states[n - 1].pose.position) / options.step.value());
      }
      for (std::size_t n = 3; n < secants.size(); ++n) {
        const double changes = (secants[n] - secants[n - 1]).norm() + (secants[n - 1] - secants[n - 2]).norm() +
                               (secants[n - 2] - secants[n - 3]).norm();
        const Vector3 mean = 0.5 * (states[n].velocity + states[n + 1].velocity);
        EXPECT_LT((secants[n] - mean).norm(), changes) << scheme.name << ", probe " << probe;
        if (n > 20) {
          EXPECT_LT(changes, 0.2 * secants[n].norm()) << scheme.name << ", probe " << probe;
        }
      }
    }
  }
}

TEST_F(SmallArm, CommandsHoldUntilReleased) {
  SimulationOptions options;
  Simulation s(scene_, options);
  EXPECT_TRUE(s.is_commandable(0));
  s.command_effort(0, 2);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(0), 2);
  s.command_effort(0, 1e6);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(0), 3) << "saturates";
  s.release_command(0);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(0), 0);
  s.command_effort(0, 2);
  s.reset();
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(0), 0) << "a reset forgets commands";
}

TEST_F(SmallArm, CommandReplacesTheScenesEffort) {
  scene_.efforts.push_back({"rail", TimeFunction(5.0), {}});
  Simulation s(scene_);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(1), 5);
  s.command_effort(1, 0);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(1), 0);
  s.release_command(1);
  ASSERT_TRUE(s.step().converged);
  EXPECT_DOUBLE_EQ(s.effort(1), 5);
}

TEST_F(SmallArm, RefusesNonsense) {
  Simulation s(scene_);
  EXPECT_THROW(s.command_effort(0, NAN), std::invalid_argument);
  EXPECT_THROW(s.command_effort(0, INFINITY), std::invalid_argument);
  EXPECT_THROW(s.command_effort(99, 1), std::out_of_range);
  EXPECT_THROW(s.position(99), std::out_of_range);
  EXPECT_THROW(s.link_pose(99), std::out_of_range);
  EXPECT_THROW(s.probe(99), std::out_of_range);
  EXPECT_THROW(s.solve_static(0), std::invalid_argument);
  EXPECT_THROW(s.natural_modes(0), std::invalid_argument);
  ASSERT_TRUE(s.step().converged);

  EXPECT_THROW(Simulation(scene_, options("euler")), ModelError);
  for (const double step : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    SimulationOptions bad;
    bad.step = step;
    EXPECT_THROW(Simulation(scene_, bad), ModelError) << step;
    bad.step.reset();
    bad.tolerance = step;
    EXPECT_THROW(Simulation(scene_, bad), ModelError) << step;
  }
}

TEST_F(SmallArm, PrescribedCoordinatesCannotBeCommanded) {
  scene_.motions.push_back({"rail", TimeFunction(0.1), {}});
  Simulation s(scene_);
  EXPECT_FALSE(s.is_commandable(1));
  EXPECT_THROW(s.command_effort(1, 1), std::invalid_argument);
}

TEST_F(SmallArm, BeamPointsRunAlongTheBeam) {
  Simulation s(scene_);
  for (int n = 0; n < 20; ++n) ASSERT_TRUE(s.step().converged);
  std::vector<BeamPoint> points;
  s.beam_points(2, 1, points);
  ASSERT_EQ(points.size(), 2u * 2 * 2 + 1);
  EXPECT_DOUBLE_EQ(points.front().arc_length, 0);
  EXPECT_NEAR(points.back().arc_length, 1, 1e-15);
  EXPECT_LT((points.front().pose.position - s.link_pose(2).position).norm(), 1e-14);
  EXPECT_LT((points.back().pose.position - s.tip_pose(2).position).norm(), 1e-14);
  s.beam_points(1, 1, points);
  EXPECT_EQ(points.size(), 9u) << "a rigid link has none";
}

TEST(Simulation, MassWithoutMotionIsRefused) {
  SceneBuilder b;
  scene::LinkDescription massless;
  massless.name = "ghost";
  b.scene.links.push_back(massless);
  b.joint("hinge", JointKind::Revolute, "world", "ghost", {0, 0, 0}, {0, 0, 1});
  EXPECT_THROW(Simulation{b.scene}, ModelError);
}

TEST(Simulation, OptionsOverrideTheScene) {
  const Simulation s(everything_scene().scene, options("newmark", 0.0005));
  EXPECT_EQ(s.scheme(), "newmark");
  EXPECT_DOUBLE_EQ(s.step_size(), 0.0005);
}

TEST(Simulation, TimeCountsWholeSteps) {
  Simulation s(everything_scene().scene);
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(s.step().converged);
  EXPECT_NEAR(s.time(), 0.2, 1e-14);
  EXPECT_EQ(state_of(s).steps, 100);
}

TEST(Simulation, MomentaAreThoseOfTheMotion) {
  SceneBuilder b;
  b.body("body", 2, {0.5, 0, 0}, Vector3(1, 2, 3).asDiagonal());
  b.joint("free", JointKind::Floating, "world", "body", {0, 1, 0});
  b.scene.initial_links.push_back({"body", {1, 2, 3}, {0, 0, 4}, {}});
  const Simulation s(b.scene);
  const Vector3 velocity(1, 2 + 4 * 0.5, 3), center(0.5, 1, 0);
  EXPECT_LT((s.momentum() - 2 * velocity).norm(), 1e-13);
  EXPECT_LT((s.angular_momentum() - 2 * center.cross(velocity) - Vector3(0, 0, 12)).norm(), 1e-13);
  EXPECT_NEAR(s.energies().kinetic, 0.5 * 2 * velocity.squaredNorm() + 0.5 * 3 * 16, 1e-12);
}

TEST_F(SmallArm, SaysWhichIndexIsWrong) {
  Simulation s(scene_);
  const std::string links = "link 9: expected an index from 0 to 3",
                    coordinates = "joint coordinate 9: expected an index from 0 to 4";
  std::vector<BeamPoint> points;
  AppliedWrench wrench;
  wrench.link = 9;
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.link_pose(9); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.tip_pose(9); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.beam_points(9, 0, points); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.section(9, 0); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.reaction(9); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.apply_wrenches({wrench}); }), links);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.position(9); }), coordinates);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.effort(9); }), coordinates);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.release_command(9); }), coordinates);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.release_set_point(9); }), coordinates);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.set_joint_state({{9, 0.0, {}}}); }), coordinates);
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.probe_pose(2); }), "probe 2: expected an index from 0 to 1");
  EXPECT_EQ(refusal<std::out_of_range>([&] { s.sample(0); }), "sensor 0: there is none");
}

TEST_F(SmallArm, RefusesLessThanNoPointsBetweenNodes) {
  const Simulation s(scene_);
  const std::string expected = "between: expected a number of points >= 0, got -1";
  for (const std::size_t link : {1u, 2u}) {  // a rigid link and a flexible one
    std::vector<BeamPoint> points;
    EXPECT_EQ(refusal<std::invalid_argument>([&] { s.beam_points(link, -1, points); }), expected);
    EXPECT_TRUE(points.empty());
    EXPECT_EQ(refusal<std::invalid_argument>([&] { s.undeformed_sections(link, -1); }), expected);
  }
}

TEST_F(SmallArm, ExplainsNoResultOfAnotherScene) {
  const Simulation s(scene_);
  StepResult result;
  EXPECT_EQ(s.explain(result), "");
  result.reason = StepResult::Reason::NoConvergence;
  EXPECT_FALSE(s.explain(result).empty()) << "the place need not be known";
  const auto expect_refused = [&](const StepResult::Place& place) {
    result.failure.place = place;
    EXPECT_NE(refusal<std::invalid_argument>([&] { s.explain(result); }).find("not in this scene"), std::string::npos);
  };
  expect_refused({4, -1, -1, -1, Vector3::Zero()});
  expect_refused({-1, -1, 5, -1, Vector3::Zero()});
  expect_refused({-1, -1, -1, 0, Vector3::Zero()});
  expect_refused({1, 0, -1, -1, Vector3::Zero()});  // a rigid link has no elements
  result.failure.place = {2, 1, -1, -1, Vector3::Zero()};
  EXPECT_NE(s.explain(result).find("element 2 of 2 of link 'boom'"), std::string::npos);
}

TEST_F(SmallArm, RefusesATimeForRecoveryThatIsNone) {
  SimulationOptions options;
  for (const double time : {-1.0, double(NAN)}) {
    options.recovery_wall_time = time;
    EXPECT_NE(
        refusal<ModelError>([&] { Simulation(scene_, options); }).find("recovery_wall_time: expected a time >= 0"),
        std::string::npos)
        << time;
  }
}

}  // namespace
}  // namespace flexarm::test
