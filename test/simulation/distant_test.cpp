// Tests that mechanisms far from the world's origin move exactly as they do near it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "simulation/inside.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// An arm of a body and a beam, held at `place` by a joint of the given kind. A rod stands beside it and carries its
/// end, which closes a loop. Each link has a probe.
scene::SceneDescription arm(JointKind kind, const Vector3& place) {
  SceneBuilder b;
  b.scene.gravity = Vector3(0, 0, -9.81);
  b.body("upper", 1, {0.5, 0, 0}, Vector3(0.1, 0.2, 0.15).asDiagonal());
  b.beam("lower", {{0.5, 0, -0.5}}, section(1e4, 4e3, 30, 40, 0.5, 1e-3, 5e-4), 3, 2);
  b.joint("root", kind, "world", "upper", place, Vector3::UnitY());
  b.joint("elbow", JointKind::Continuous, "upper", "lower", {1, 0, 0}, Vector3::UnitY());
  b.probe("tip", "lower", {0.5, 0, -0.5});
  b.probe("ground", "world", place);
  b.load("lower", {0.5, 0, -0.5}, {1, 2, 3}, {0.1, 0, 0.2}, "sin(5*t)");
  return b.scene;
}

/// The arm with its tip attached to the world.
scene::SceneDescription held_arm(const Vector3& place) {
  SceneBuilder b;
  b.scene = arm(JointKind::Continuous, place);
  close_loop(b, "stay", JointKind::Spherical, "world", "lower", {0.5, 0, -0.5}).origin.position =
      place + Vector3(1.5, 0, -0.5);
  return b.scene;
}

void expect_alike(const scene::SceneDescription& near, const scene::SceneDescription& far, const Vector3& place) {
  Simulation here(near), there(far);
  // Positions are rounded in the scene, and again where they are read.
  const double unit = std::numeric_limits<double>::epsilon() * place.norm();
  for (int n = 0; n < 100; ++n) {
    const StepResult result = here.step(), distant = there.step();
    ASSERT_TRUE(result.converged && distant.converged) << to_string(distant.reason);
    EXPECT_EQ(distant.iterations, result.iterations);
  }
  for (std::size_t i = 0; i < here.coordinate_names().size(); ++i) {
    EXPECT_EQ(there.position(i), here.position(i)) << here.coordinate_names()[i];
    EXPECT_EQ(there.velocity(i), here.velocity(i)) << here.coordinate_names()[i];
  }
  EXPECT_EQ(there.energies().total(), here.energies().total());
  EXPECT_EQ(there.momentum(), here.momentum());
  for (std::size_t i = 0; i < here.link_names().size(); ++i) {
    const Vector3 moved = here.link_names()[i] == "world" ? Vector3::Zero() : place;
    EXPECT_LE((there.link_pose(i).position - here.link_pose(i).position - moved).norm(), 2 * unit);
    if (here.is_flexible(i)) {
      EXPECT_LE((there.tip_pose(i).position - here.tip_pose(i).position - place).norm(), 2 * unit);
    }
  }
  EXPECT_LE((there.probe(0).pose.position - here.probe(0).pose.position - place).norm(), 2 * unit);
  EXPECT_LE((there.probe(1).pose.position - place).norm(), 2 * unit);
  std::vector<BeamPoint> points, distant;
  here.beam_points(2, 1, points);
  there.beam_points(2, 1, distant);
  ASSERT_EQ(points.size(), distant.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE((distant[i].pose.position - points[i].pose.position - place).norm(), 2 * unit);
    EXPECT_EQ(distant[i].strain, points[i].strain);
  }
}

TEST(Distant, ArmsMoveAsAtTheOrigin) {
  for (const double distance : {1e3, 1e6, 1e9, 1e12}) {
    const Vector3 place = distance * Vector3(0.6, -0.48, 0.64);
    for (const JointKind kind : {JointKind::Continuous, JointKind::Floating})
      expect_alike(arm(kind, Vector3::Zero()), arm(kind, place), place);
  }
}

// The scene rounds the place where the world holds the tip. Powers of two add no rounding error.
TEST(Distant, LoopsToTheWorldAsWell) {
  const Vector3 place(std::ldexp(1, 30), 0, -std::ldexp(1, 20));
  expect_alike(held_arm(Vector3::Zero()), held_arm(place), place);
}

/// The arm on a floating joint whose translations start at `place`.
scene::SceneDescription floating_arm(const Vector3& place, const Vector3& velocity) {
  scene::SceneDescription scene = arm(JointKind::Floating, Vector3::Zero());
  for (int k = 0; k < 3; ++k)
    scene.initial_joints.push_back({std::string("root/") + "xyz" [k], place[k], velocity[k], {}, true});
  return scene;
}

TEST(Distant, FloatingJointsMayHaveLargeCoordinates) {
  for (const double distance : {1e3, 1e6, 1e9, 1e12}) {
    const Vector3 place = distance * Vector3(0.6, -0.48, 0.64);
    Simulation here(floating_arm(Vector3::Zero(), {1, 2, 3})), there(floating_arm(place, {1, 2, 3}));
    const double unit = std::numeric_limits<double>::epsilon() * distance;
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(here.step().converged && there.step().converged);
    EXPECT_EQ(there.energies().total(), here.energies().total());
    EXPECT_EQ(there.momentum(), here.momentum());
    for (std::size_t i = 0; i < here.coordinate_names().size(); ++i) {
      const Vector3 moved = i < 3 ? place : Vector3::Zero();
      EXPECT_NEAR(there.position(i) - moved[i % 3], here.position(i), i < 3 ? unit : 0) << here.coordinate_names()[i];
      EXPECT_EQ(there.velocity(i), here.velocity(i)) << here.coordinate_names()[i];
    }
    for (std::size_t i = 0; i < here.link_names().size(); ++i) {
      const Vector3 moved = here.link_names()[i] == "world" ? Vector3::Zero() : place;
      EXPECT_LE((there.link_pose(i).position - here.link_pose(i).position - moved).norm(), 2 * unit);
    }
    EXPECT_EQ(there.probe(1).pose.position, here.probe(1).pose.position) << "the ground";
    // A snapshot loses no digit: after it is restored, the same step gives the same result.
    const Snapshot before = there.snapshot();
    ASSERT_TRUE(there.step().converged);
    const Vector3 tip = there.probe(0).pose.position;
    there.restore(before);
    ASSERT_TRUE(there.step().converged);
    EXPECT_EQ(there.probe(0).pose.position, tip);
  }
}

// The rounding error of positions must not grow with the distance travelled. Positions are rounded relative to one
// step's travel; this disturbs the rod in every step. Rounded relative to the whole distance, the disturbance would be
// a thousand times as large.
TEST(Distant, FlightsDoNotStrain) {
  constexpr double kStiffness = 1e9, kLength = 1, kSpeed = 1e6;
  constexpr int kElements = 4, kSteps = 1000;
  SceneBuilder b;
  b.scene.gravity.setZero();
  b.beam("rod", {{kLength, 0, 0}}, section(kStiffness, 4e8, 3e6, 4e6, 5, 1e-2, 5e-3), kElements, 2);
  b.joint("root", JointKind::Floating, "world", "rod");
  b.scene.initial_joints.push_back({"root/x", 0, kSpeed, {}, true});
  Simulation simulation(b.scene);
  const double epsilon = std::numeric_limits<double>::epsilon(), way = kSpeed * kSteps * simulation.step_size();
  double largest = 0;
  for (int n = 0; n < kSteps; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    largest = std::max(largest, std::sqrt(2 * simulation.energies().strain / (kStiffness * kLength)));
  }
  EXPECT_LT(largest, 8 * epsilon * kSpeed * simulation.step_size() * kElements / kLength * std::sqrt(kSteps));
  EXPECT_NEAR(simulation.position(0), way, epsilon * way * kSteps);
  EXPECT_NEAR(simulation.link_pose(1).position.x(), way, epsilon * way * kSteps);
  EXPECT_EQ(simulation.link_pose(0).position, Vector3::Zero()) << "the world stays where it is";
}

TEST(Distant, AngularMomentumIsAboutTheWorldsOrigin) {
  const Vector3 place(1e6, 0, 0);
  scene::SceneDescription near = arm(JointKind::Floating, Vector3::Zero()), far = arm(JointKind::Floating, place);
  Simulation here(near), there(far);
  for (int n = 0; n < 50; ++n) here.step(), there.step();
  const Vector3 expected = here.angular_momentum() + place.cross(here.momentum());
  EXPECT_LE((there.angular_momentum() - expected).norm(),
            4 * std::numeric_limits<double>::epsilon() * place.norm() * here.momentum().norm());
}

// The origin of a mechanism near the world's origin is not moved.
TEST(Distant, NearMechanismsKeepTheWorldsOrigin) {
  for (const double distance : {0.0, 1.0, 50.0})
    EXPECT_EQ(model_of(Simulation(arm(JointKind::Continuous, distance * Vector3::UnitX()))).origin, Vector3::Zero());
}

}  // namespace
}  // namespace flexarm::test
