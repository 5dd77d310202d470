// Tests payloads that are attached and detached, and models that are spawned and removed, while a simulation moves.
#include "flexarm/simulation/payloads.h"

#include <cmath>

#include "simulation/everything_scene.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

void expect_near(const Vector3& value, const Vector3& expected, double tolerance) {
  EXPECT_LE((value - expected).norm(), tolerance) << value.transpose() << " is not " << expected.transpose();
}

void float_body(SceneBuilder& b, const std::string& name, double mass, const Vector3& place, const Vector3& linear,
                const Vector3& angular) {
  b.body(name, mass, {0.02, -0.01, 0.03}, mass * Vector3(0.02, 0.03, 0.04).asDiagonal().toDenseMatrix());
  b.joint(name + "_free", JointKind::Floating, "world", name);
  for (int k = 0; k < 3; ++k) b.scene.initial_joints.push_back({name + "_free/" + "xyz" [k], place[k], 0, {}});
  b.scene.initial_links.push_back({name, linear, angular, {}});
}

SceneBuilder two_bodies() {
  SceneBuilder b;
  b.scene.integrator.step = 0.005;
  float_body(b, "tug", 3, {0, 0, 0}, {1, 0.2, -0.1}, {0.4, -0.7, 1.1});
  float_body(b, "box", 1.5, {0.5, 0.1, 0.2}, {-0.6, 0.3, 0.5}, {-1.2, 0.5, 0.3});
  return b;
}

/// A flexible arm on a turning hinge, and a box that flies beside its tip.
SceneBuilder arm_and_box() {
  SceneBuilder b;
  b.scene.integrator.step = 0.002;
  float_body(b, "base", 4, {0, 0, 0}, {0.1, 0, 0.05}, {0, 0.1, 0.2});
  b.beam("boom", {{1, 0, 0}}, section(2e4, 1e4, 200, 250, 0.5, 2e-3, 1e-3), 4, 2);
  b.joint("hinge", JointKind::Revolute, "base", "boom", {0.1, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"hinge", 0.2, 0.8, {}});
  float_body(b, "box", 0.8, {1.15, 0.25, 0.05}, {-0.5, 0.6, 0.2}, {0.3, -0.4, 0.5});
  return b;
}

TEST(Attach, TwoBodiesInFlightGoOnAsOne) {
  for (const char* scheme : {"em", "m1", "newmark", "hht2", "edmc2"}) {
    SCOPED_TRACE(scheme);
    SceneBuilder b = two_bodies();
    b.scene.integrator = with_scheme(b.scene.integrator, scheme);
    Simulation s(b.scene);
    run(s, 40);
    const Vector3 momentum = s.momentum(), spin = s.angular_momentum();
    const double account = energy_account(s), kinetic = s.energies().kinetic;
    const Pose box = s.link_pose(link_of(s, "box"));
    const double time = s.time();

    // Closed form: the kinetic energy of the rigid body with the same momenta.
    const Model& model = model_of(s);
    const State& state = state_of(s);
    double mass = 0;
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      mass += model.inertias[i].mass;
      centre += model.inertias[i].mass * state.nodes[i].position;
    }
    centre /= mass;
    Matrix3 inertia = Matrix3::Zero();
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      const Vector3 arm = state.nodes[i].position - centre;
      const Matrix3 turn = state.nodes[i].orientation.toRotationMatrix();
      inertia += turn * model.inertias[i].rotary * turn.transpose() +
                 model.inertias[i].mass * (arm.squaredNorm() * Matrix3::Identity() - arm * arm.transpose());
    }
    const Vector3 own_spin = spin - centre.cross(momentum);
    const double left = 0.5 * momentum.squaredNorm() / mass + 0.5 * own_spin.dot(inertia.inverse() * own_spin);
    const double dissipated = s.energies().dissipated;

    attach(s, "box", "tug");
    EXPECT_EQ(s.time(), time);
    expect_near(s.momentum(), momentum, 1e-10 * momentum.norm());
    expect_near(s.angular_momentum(), spin, 1e-10 * spin.norm());
    EXPECT_NEAR(s.energies().kinetic, left, 1e-10 * kinetic);
    EXPECT_NEAR(s.energies().dissipated - dissipated, kinetic - left, 1e-10 * kinetic);
    EXPECT_NEAR(energy_account(s), account, 1e-10 * kinetic);
    expect_near(s.link_pose(link_of(s, "box")).position, box.position, 1e-12);
    EXPECT_EQ(s.coordinate_names().size(), 6u);

    const Pose relative = s.link_pose(1).inverse() * s.link_pose(2);
    run(s, 100);
    expect_near((s.link_pose(1).inverse() * s.link_pose(2)).position, relative.position, 1e-12);
    const Vector3 later = s.momentum(), later_spin = s.angular_momentum();
    const double energy = s.energies().kinetic;
    detach(s, "box");
    expect_near(s.momentum(), later, 1e-10 * momentum.norm());
    expect_near(s.angular_momentum(), later_spin, 1e-10 * spin.norm());
    EXPECT_NEAR(s.energies().kinetic, energy, 1e-10 * kinetic);
    EXPECT_EQ(s.coordinate_names().size(), 12u);
    run(s, 100);
    s.reset();
    run(s, 10);
  }
}

TEST(Attach, AFlexibleArmTakesABoxAndLetsItGo) {
  for (const char* scheme : {"em", "m1", "newmark", "hht2", "edmc2"}) {
    SCOPED_TRACE(scheme);
    SceneBuilder b = arm_and_box();
    b.scene.integrator = with_scheme(b.scene.integrator, scheme);
    Simulation s(b.scene);
    run(s, 20);
    const Vector3 momentum = s.momentum(), spin = s.angular_momentum();
    const double account = energy_account(s), energy = s.energies().total(), dissipated = s.energies().dissipated;
    std::vector<BeamPoint> before, after;
    s.beam_points(link_of(s, "boom"), 0, before);
    const double strain = s.energies().strain;
    attach(s, "box", "boom");
    expect_near(s.momentum(), momentum, 1e-10 * momentum.norm());
    expect_near(s.angular_momentum(), spin, 1e-10 * spin.norm());
    EXPECT_NEAR(energy_account(s), account, 1e-10 * energy);
    EXPECT_GT(s.energies().dissipated, dissipated + 1e-3 * energy);
    EXPECT_NEAR(s.energies().strain, strain, 1e-9 * energy);
    s.beam_points(link_of(s, "boom"), 0, after);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) expect_near(after[i].pose.position, before[i].pose.position, 1e-13);

    run(s, 100);
    const Vector3 late = s.momentum(), late_spin = s.angular_momentum();
    const double late_account = energy_account(s);
    detach(s, "box");
    expect_near(s.momentum(), late, 1e-10 * momentum.norm());
    expect_near(s.angular_momentum(), late_spin, 1e-10 * spin.norm());
    EXPECT_NEAR(energy_account(s), late_account, 1e-10 * energy);
    run(s, 50);
    if (b.scene.integrator.scheme != "em") continue;
    EXPECT_NEAR(energy_account(s), account, 1e-6 * energy);
    expect_near(s.momentum(), momentum, 1e-8 * momentum.norm());
    expect_near(s.angular_momentum(), spin, 1e-8 * spin.norm());
  }
}

TEST(Attach, MovesAsASceneThatHadThePayloadFromTheStart) {
  const auto arm = [] {
    SceneBuilder b;
    b.scene.integrator.step = 0.002;
    b.scene.gravity = {0, 0, -9.81};
    b.beam("boom", {{1, 0, 0}}, section(2e4, 1e4, 200, 250, 0.5, 2e-3, 1e-3), 4, 2);
    b.joint("hinge", JointKind::Revolute, "world", "boom", {0, 0, 0}, {0, 1, 0});
    return b;
  };
  for (const double place : {1.0, 0.53}) {  // at the tip, or near the middle (the nearest border of elements is at 0.5)
    SceneBuilder with = arm(), without = arm();
    const Matrix3 inertia = 0.01 * Matrix3::Identity();
    with.body("box", 0.8, {0, 0, 0.05}, inertia);
    const double border = place == 1.0 ? 1.0 : 0.5;
    scene::JointDescription& weld = with.joint("box_free", JointKind::Fixed, "boom", "box", {border, 0, 0});
    weld.child_origin.position = {border - place, 0, -0.1};
    without.body("box", 0.8, {0, 0, 0.05}, inertia);
    without.joint("box_free", JointKind::Floating, "world", "box");
    without.scene.initial_joints.push_back({"box_free/x", place, 0, {}});
    without.scene.initial_joints.push_back({"box_free/z", 0.1, 0, {}});
    Simulation always(with.scene), taken(without.scene);
    attach(taken, "box", "boom");
    run(always, 200), run(taken, 200);
    expect_near(taken.tip_pose(link_of(taken, "boom")).position, always.tip_pose(link_of(always, "boom")).position,
                1e-7);
    expect_near(taken.link_pose(link_of(taken, "box")).position, always.link_pose(link_of(always, "box")).position,
                1e-7);
    EXPECT_NEAR(taken.velocity(0), always.velocity(0), 1e-6);
    EXPECT_NEAR(energy_account(taken), energy_account(always), 1e-8);
  }
}

TEST(Attach, AFlexiblePayloadIsTakenByARigidLink) {
  SceneBuilder b = two_bodies();
  b.beam("mast", {{0, 0, 1}}, section(2e4, 1e4, 200, 250, 0.5, 2e-3, 1e-3), 3, 2);
  b.joint("mast_free", JointKind::Floating, "world", "mast");
  b.scene.initial_joints.push_back({"mast_free/x", 2, 0, {}});
  b.scene.initial_links.push_back({"mast", {0.1, 0.2, 0.3}, {0.5, 0.4, -0.3}, {}});
  Simulation s(b.scene);
  run(s, 10);
  const Vector3 momentum = s.momentum(), spin = s.angular_momentum();
  const double account = energy_account(s);
  attach(s, "mast", "box");
  attach(s, "tug", "mast");
  expect_near(s.momentum(), momentum, 1e-10 * momentum.norm());
  expect_near(s.angular_momentum(), spin, 1e-10 * spin.norm());
  EXPECT_NEAR(energy_account(s), account, 1e-9);
  run(s, 20);
  detach(s, "mast");
  run(s, 20);
}

template <class Change>
void expect_error(const std::string& part, const Change& change) {
  expect_contains(refusal<std::invalid_argument>(change), part);
}

TEST(Attach, SaysWhatIsWrong) {
  Simulation s(arm_and_box().scene);
  expect_error("there is no link 'nobody'", [&] { attach(s, "nobody", "boom"); });
  expect_error("there is no link 'nobody'", [&] { attach(s, "box", "nobody"); });
  expect_error("'boom' does not float: joint 'hinge'", [&] { attach(s, "boom", "box"); });
  expect_error("a loop would arise: link 'boom' hangs on 'base'", [&] { attach(s, "base", "boom"); });
  expect_error("a loop would arise", [&] { attach(s, "box", "box"); });
  expect_error("'box' floats", [&] { detach(s, "box"); });
  expect_error("not of type 'fixed'", [&] { detach(s, "boom"); });
  expect_error("is the world", [&] { detach(s, "world"); });
  attach(s, "box", "boom");
  expect_error("'box' is attached already", [&] { attach(s, "box", "base"); });
  expect_error("there is no link 'nobody'", [&] { remove(s, "nobody"); });
  expect_error("is the world", [&] { remove(s, "world"); });
  run(s, 5);
}

TEST(Detach, FreesALinkOfTheScene) {
  SceneBuilder b = arm_and_box();
  b.body("tool", 0.5, {0, 0.05, 0}, 0.01 * Matrix3::Identity());
  b.joint("weld", JointKind::Fixed, "boom", "tool", {0.37, 0, 0});  // a border of elements is made at the joint
  Simulation s(b.scene);
  run(s, 30);
  const Vector3 momentum = s.momentum(), spin = s.angular_momentum();
  const double account = energy_account(s);
  detach(s, "tool");
  expect_near(s.momentum(), momentum, 1e-10 * momentum.norm());
  expect_near(s.angular_momentum(), spin, 1e-10 * spin.norm());
  EXPECT_NEAR(energy_account(s), account, 1e-9);
  run(s, 30);
  attach(s, "tool", "boom");
  run(s, 30);
}

scene::SceneDescription ball(double radius) {
  scene::SceneDescription model;
  model.name = "ball";
  model.file = "ball.urdf";
  model.root_link = "ball";
  model.links.push_back({"ball", scene::RigidInertia{0.5, Vector3::Zero(), 1e-3 * Matrix3::Identity()}, {}, {}});
  scene::VisualDescription shape;
  shape.shape = scene::SphereShape{radius};
  model.links.back().collisions.push_back(shape);
  return model;
}

TEST(Spawn, WhatMovesGoesOnAndTheNewBodyFlies) {
  // The spawned body restarts the predictor, so results differ by the tolerance of Newton's method.
  constexpr double tolerance = 1e-7;
  for (const char* scheme : {"em", "newmark", "edmc2", "hht1", "hht2", "hht3"}) {
    SCOPED_TRACE(scheme);
    scene::SceneDescription scene = driven_scene().scene;
    scene.integrator = with_scheme(scene.integrator, scheme);
    Simulation s(scene), alone(scene);
    run(s, 40), run(alone, 40);
    const double account = energy_account(s);
    Spawn where{{{3, 4, 5}, Quaternion(Eigen::AngleAxisd(0.4, Vector3::UnitY()))}, {0.1, 0.2, 0.3}, {1, 2, 3}, "new_"};
    spawn(s, ball(0.1), where);
    EXPECT_EQ(s.time(), alone.time());
    EXPECT_NEAR(energy_account(s), account, 1e-9 * (1 + std::abs(account)));
    const std::size_t link = link_of(s, "new_ball");
    ASSERT_LT(link, s.link_names().size());
    expect_near(s.link_pose(link).position, where.pose.position, 1e-14);
    const double start = s.time();
    run(s, 40), run(alone, 40);
    for (std::size_t i = 0; i < alone.coordinate_names().size(); ++i)
      EXPECT_NEAR(s.position(*s.find_coordinate(alone.coordinate_names()[i])), alone.position(i), tolerance)
          << alone.coordinate_names()[i];
    const double t = s.time() - start;
    const Vector3 expected = where.pose.position + t * where.linear + 0.5 * t * t * scene.gravity;
    expect_near(s.link_pose(link).position, expected, 1e-9);
    remove(s, "new_ball");
    EXPECT_EQ(s.link_names(), alone.link_names());
    run(s, 40), run(alone, 40);
    for (std::size_t i = 0; i < alone.coordinate_names().size(); ++i)
      EXPECT_NEAR(s.position(i), alone.position(i), tolerance) << alone.coordinate_names()[i];
  }
}

TEST(Spawn, ANewBallFallsOnTheGroundAndIsTaken) {
  SceneBuilder b;
  b.scene.integrator.step = 0.002;
  b.scene.gravity = {0, 0, -9.81};
  b.body("rod", 1, {0, 0, -0.5}, 0.05 * Matrix3::Identity());
  b.joint("pivot", JointKind::Revolute, "world", "rod", {0, 0, 1}, {0, 1, 0});
  scene::GroundDescription ground;
  ground.name = "floor";
  b.scene.grounds.push_back(ground);
  scene::ContactDescription all;
  all.first = all.second = scene::kAllBodies;
  all.restitution.values = {0.05};
  b.scene.contacts.push_back(all);
  Simulation s(b.scene);
  run(s, 5);
  spawn(s, ball(0.1), {{{3, 0, 0.2}, Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero(), ""});
  spawn(s, ball(0.1), {{{3, 0.05, 0.42}, Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero(), "upper_"});
  run(s, 500);
  EXPECT_NEAR(s.link_pose(link_of(s, "ball")).position.z(), 0.1, 2e-3);
  EXPECT_NEAR(s.link_pose(link_of(s, "upper_ball")).position.z(), 0.1, 2e-3);
  attach(s, "upper_ball", "ball");
  run(s, 50);
  remove(s, "ball");
  EXPECT_EQ(link_of(s, "upper_ball"), s.link_names().size()) << "what it carried went with it";
  run(s, 20);
}

TEST(Spawn, AMechanismHangsOnTheWorldAtItsPose) {
  SceneBuilder pendulum;
  pendulum.body("rod", 1, {0, 0, -0.5}, 0.05 * Matrix3::Identity());
  pendulum.joint("pivot", JointKind::Revolute, "world", "rod", {0, 0, 1}, {0, 1, 0});
  pendulum.scene.initial_joints.push_back({"pivot", 0.3, 0, {}});
  pendulum.servo("pivot", 5, 1);
  Simulation s(two_bodies().scene);
  run(s, 5);
  spawn(s, pendulum.scene, {{{2, 0, 0}, Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero(), "left/"});
  spawn(s, pendulum.scene, {{{-2, 0, 0}, Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero(), "right/"});
  expect_near(s.link_pose(link_of(s, "right/rod")).position, {-2, 0, 1}, 1e-14);
  const std::size_t pivot = *s.find_coordinate("left/pivot");
  EXPECT_TRUE(s.has_servo(pivot));
  EXPECT_NEAR(s.position(pivot), 0.3, 1e-14);
  run(s, 20);
  s.command_set_point(pivot, 0.7);
  attach(s, "box", "right/rod");
  EXPECT_NEAR(s.set_point(*s.find_coordinate("left/pivot")), 0.7, 0);
  run(s, 20);
  remove(s, "left/rod");
  EXPECT_FALSE(s.find_coordinate("left/pivot").has_value());
  run(s, 20);
  const Spawn again{{}, Vector3::Zero(), Vector3::Zero(), "right/"}, moving{{}, {1, 0, 0}, Vector3::Zero(), "more/"};
  expect_error("there is a link 'right/rod' already", [&] { spawn(s, pendulum.scene, again); });
  expect_error("root link floats", [&] { spawn(s, pendulum.scene, moving); });
  run(s, 5);
}

}  // namespace
}  // namespace flexarm::test
