// Tests the errors of scenes that are impossible as mechanisms.
#include <limits>

#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "building/model_builder.h"
#include "elements/random_element.h"
#include "support/scene_builder.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

/// A body "arm" on a joint "hinge".
SceneBuilder arm() {
  SceneBuilder builder;
  builder.body("arm", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("hinge", JointKind::Revolute, "world", "arm").location = {"s.urdf", 12};
  return builder;
}

TEST(ModelErrors, TheArmItselfIsFine) {
  EXPECT_NO_THROW(build_model(arm().scene));
}

TEST(ModelErrors, NothingOutboardHasInertia) {
  SceneBuilder builder = arm();
  builder.scene.links.push_back({"ghost", {}, {}, {}});
  builder.joint("idle", JointKind::Revolute, "arm", "ghost");
  expect_error(builder.scene, "'idle' moves nothing");
  builder.scene.motions.push_back({"idle", TimeFunction(0.3), {}});
  EXPECT_NO_THROW(build_model(builder.scene));  // a driven joint needs no inertia
}

TEST(ModelErrors, AllMasslessJointsAreNamedAtOnce) {
  SceneBuilder builder = arm();
  builder.scene.links.push_back({"ghost", {}, {}, {}});
  builder.scene.links.push_back({"shadow", {}, {}, {}});
  builder.joint("idle", JointKind::Revolute, "arm", "ghost").location = {"s.urdf", 13};
  builder.joint("loose", JointKind::Universal, "ghost", "shadow").location = {"s.urdf", 14};
  for (const char* text :
       {"s.urdf:13: <joint>: joint coordinate 'idle' moves nothing that has inertia\n",
        "s.urdf:14: <joint>: joint coordinate 'loose/1' moves nothing that has inertia\n",
        "s.urdf:14: <joint>: joint coordinate 'loose/2' moves nothing", "or hold those with one coordinate"})
    expect_error(builder.scene, text);
}

TEST(ModelErrors, MasslessJointsAreHeldWhereTheyStartOnDemand) {
  SceneBuilder builder = arm();
  builder.scene.links.push_back({"ghost", {}, {}, {}});
  scene::JointDescription& idle = builder.joint("idle", JointKind::Revolute, "arm", "ghost");
  idle.limits = scene::JointLimits{-1, 1};
  builder.scene.initial_joints.push_back({"idle", 0.3, 2, {}, true});
  builder.scene.efforts.push_back({"idle", TimeFunction(5), {}});
  builder.scene.lock_massless = true;
  const Model model = build_model(builder.scene);
  ASSERT_EQ(model.coordinates.size(), 2u);
  EXPECT_LT(model.coordinates[0].motion, 0);  // the hinge moves the arm, so it is free
  const Coordinate& held = model.coordinates[1];
  ASSERT_GE(held.motion, 0);
  EXPECT_EQ(model.histories[held.motion](1.0), 0.3);
  EXPECT_EQ(model.initial_released[held.joint].displacement[0], 0.3);
  EXPECT_LT(held.effort, 0);
  EXPECT_FALSE(held.limit);
  // Functions of time are differentiated by differences: an error of round-off to the power 2/3.
  EXPECT_LE(model.initial_velocity[model.joints[held.joint].slave].norm(), 4e-11);
}

TEST(ModelErrors, FramesWithoutInertiaAreFixedWhereTheyStartOnDemand) {
  for (const JointKind kind : {JointKind::Spherical, JointKind::Floating}) {
    SceneBuilder builder = arm();
    builder.scene.links.push_back({"ghost", {}, {}, {}});
    builder.joint("idle", kind, "arm", "ghost", {0.1, 0, 0});
    const Vector3 turn(0.3, -0.2, 0.7);
    for (int k = 0; k < 3; ++k)
      builder.scene.initial_joints.push_back({std::string("idle/r") + "xyz" [k], turn[k], 0, {}, true});
    if (kind == JointKind::Floating) builder.scene.initial_joints.push_back({"idle/y", 0.5, 0, {}, true});
    builder.scene.efforts.push_back({"idle/rx", TimeFunction(5), {}});
    expect_error(builder.scene, "'idle/rx' moves nothing");
    builder.scene.lock_massless = true;
    const Model model = build_model(builder.scene);
    EXPECT_EQ(model.coordinates.size(), 1u);
    const Attachment &carrier = model.links[1].frame, &ghost = model.links[2].frame;
    ASSERT_EQ(ghost.node, carrier.node);
    const Pose place = carrier.offset.inverse() * ghost.offset;
    EXPECT_LT((place.position - Vector3(0.1, kind == JointKind::Floating ? 0.5 : 0, 0)).norm(), 1e-15);
    const Matrix3 expected = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    EXPECT_LT((place.orientation.toRotationMatrix() - expected).norm(), 1e-14);
  }
}

TEST(ModelErrors, AFreeRotationOfAPointMassCannotBeHeld) {
  SceneBuilder builder = arm();
  builder.body("bead", 1, Vector3::Zero(), Matrix3::Zero());
  builder.joint("idle", JointKind::Floating, "world", "bead");
  builder.scene.lock_massless = true;
  expect_error(builder.scene, "'idle/rx' moves nothing");
}

TEST(ModelErrors, WhatFollowsAJointIsMovedByIt) {
  SceneBuilder builder = arm();
  builder.scene.links.push_back({"handle", {}, {}, {}});
  builder.joint("crank", JointKind::Revolute, "world", "handle").limits = scene::JointLimits{-1, 1};
  expect_error(builder.scene, "'crank' moves nothing");
  builder.scene.joints[0].mimic = scene::Mimic{"crank", 3, 0};
  const Model model = build_model(builder.scene);
  // The stop of the crank sees the arm's inertia J + m l^2 about the hinge, times the square of the ratio.
  SceneBuilder alone = arm();
  alone.scene.joints[0].limits = scene::JointLimits{-1, 1};
  const double inertia = build_model(alone.scene).coordinates[0].limit->inertia;
  EXPECT_NEAR(model.coordinates[1].limit->inertia, 9 * inertia, 1e-12 * inertia);
}

TEST(ModelErrors, PointMassOnTheAxis) {
  RandomSource random(1);
  for (int repeat = 0; repeat < 10; ++repeat) {
    SceneBuilder builder;
    const Vector3 axis = random.unit();
    builder.body("bead", 1, 0.7 * axis, Matrix3::Zero());
    builder.joint("spin", JointKind::Continuous, "world", "bead", 3 * random.vector(), axis);
    expect_error(builder.scene, "'spin' moves nothing");
  }
}

// Round-off is relative to the mechanism's size, wherever it is.
TEST(ModelErrors, DistanceFromTheWorldsOriginIsNoInertia) {
  for (const double distance : {1e4, 1e6, 1e9}) {
    const Vector3 far = distance * Vector3(0.6, -0.48, 0.64);
    SceneBuilder builder;
    builder.body("finger", 0.1, Vector3(0.01, 0, 0), 1e-5 * Matrix3::Identity());
    builder.joint("knuckle", JointKind::Continuous, "world", "finger", far, Vector3::UnitZ());
    builder.scene.joints[0].limits = scene::JointLimits{-1, 1};
    const Model model = build_model(builder.scene);
    // The inertia about the axis is J + m d^2. Positions have the round-off of the distance.
    const double round_off = std::numeric_limits<double>::epsilon() * distance / 0.01;
    EXPECT_NEAR(model.coordinates[0].limit->inertia, 2e-5, 4 * round_off * 2e-5) << distance;
    builder.scene.links.push_back({"ghost", {}, {}, {}});
    builder.joint("idle", JointKind::Continuous, "finger", "ghost", Vector3::UnitX(), Vector3::UnitZ());
    expect_error(builder.scene, "'idle' moves nothing");
  }
}

TEST(ModelErrors, MeshesThatAreTooLarge) {
  for (const auto& [twist, count] :
       {std::pair(1e6, "1000000"), std::pair(1e10, "more than 1000000000"), std::pair(1e300, "more than 1000000000")}) {
    SceneBuilder builder;
    scene::BeamDescription& beam = builder.beam("rod", {{1, 0, 0}}, section(1, 1, 1, 1, 1, 1, 1), 1, 2);
    beam.elements.reset();
    beam.location = {"s.urdf", 7};
    beam.centreline[0].twist = twist;
    builder.joint("clamp", JointKind::Fixed, "world", "rod");
    expect_error(builder.scene, "s.urdf:7: <beam> of link 'rod': its mesh would have ");
    expect_error(builder.scene, twist == 1e6 ? "952381 elements" : std::string(count) + " elements");
    expect_error(builder.scene, ", but at most 100000 are possible here");
  }
  SceneBuilder builder;
  for (const std::string name : {"a", "b", "c"}) {
    builder.beam(name, {{1, 0, 0}}, section(1, 1, 1, 1, 1, 1, 1), 99999, 1).location = {"s.urdf", name[0] - 'a'};
    builder.joint("clamp_" + name, JointKind::Fixed, "world", name);
  }
  expect_error(builder.scene,
               "s.urdf:2: <beam> of link 'c': its mesh would have 99999 elements, but at most 0 are possible here");
}

TEST(ModelErrors, SectionsBeyondNumbers) {
  const auto expect_refused = [](const scene::Section& section) {
    SceneBuilder builder;
    builder.beam("rod", {{1, 0, 0}}, section, 1, 2).location = {"s.urdf", 7};
    builder.joint("clamp", JointKind::Fixed, "world", "rod");
    expect_error(builder.scene,
                 "s.urdf:7: <beam> of link 'rod': its section's stiffness and mass must be positive finite");
  };
  for (const double radius : {1e300, 1e100, 1e-100, 1e-300})
    expect_refused(scene::GeometricSection{scene::Circle{radius}, {70e9, 0.3, 2700}});
  expect_refused(scene::GeometricSection{scene::Circle{0.1}, {70e9, 0.3, 5e-324}});
  expect_refused(section(1, 1, 1, 1, 1, std::numeric_limits<double>::infinity(), 1));
}

TEST(ModelErrors, TwoParents) {
  SceneBuilder builder = arm();
  builder.joint("second", JointKind::Fixed, "world", "arm").location = {"s.urdf", 15};
  expect_error(builder.scene, "s.urdf:15: <joint>: link 'arm' has two parents");
}

TEST(ModelErrors, TwoLinksOfOneName) {
  SceneBuilder builder = arm();
  builder.body("arm", 1, Vector3::Zero(), Matrix3::Identity());
  expect_error(builder.scene, "two links are named 'arm'");
}

TEST(ModelErrors, UnconnectedLinksAndCircles) {
  SceneBuilder builder = arm();
  builder.body("lost", 1, Vector3::Zero(), Matrix3::Identity());
  expect_error(builder.scene, "not every link is connected");
  builder.body("twin", 1, Vector3::Zero(), Matrix3::Identity());
  builder.joint("there", JointKind::Fixed, "lost", "twin");
  builder.joint("back", JointKind::Fixed, "twin", "lost");
  expect_error(builder.scene, "not every link is connected");
}

TEST(ModelErrors, UnknownNames) {
  const auto with = [](auto&& change) {
    SceneBuilder builder = arm();
    change(builder);
    return builder.scene;
  };
  expect_error(with([](SceneBuilder& b) { b.joint("j", JointKind::Fixed, "nowhere", "arm"); }), "two parents");
  expect_error(with([](SceneBuilder& b) { b.joint("j", JointKind::Fixed, "arm", "nobody"); }), "no link 'nobody'");
  expect_error(with([](SceneBuilder& b) { b.load("nobody", Vector3::Zero(), Vector3::UnitX()); }), "no link 'nobody'");
  expect_error(with([](SceneBuilder& b) { b.probe("p", "nobody", Vector3::Zero()); }), "no link 'nobody'");
  expect_error(with([](SceneBuilder& b) { b.scene.root_link = "nobody"; }), "no link 'nobody'");
  expect_error(with([](SceneBuilder& b) {
                 b.scene.initial_links.push_back({"nobody", {}, {}, {}});
               }),
               "no link 'nobody'");
  expect_error(with([](SceneBuilder& b) {
                 b.scene.initial_joints.push_back({"knee", 0, 0, {"s.urdf", 3}});
               }),
               "s.urdf:3: <initial>: there is no joint coordinate 'knee'");
  expect_error(with([](SceneBuilder& b) {
                 b.scene.motions.push_back({"knee", TimeFunction(), {"s.urdf", 4}});
               }),
               "s.urdf:4: <motion>: there is no joint coordinate 'knee'");
  expect_error(with([](SceneBuilder& b) {
                 b.scene.efforts.push_back({"knee", TimeFunction(), {"s.urdf", 5}});
               }),
               "s.urdf:5: <effort>: there is no joint coordinate 'knee'");
  expect_error(with([](SceneBuilder& b) {
                 b.scene.joints[0].mimic = scene::Mimic{"knee", 1, 0};
               }),
               "there is no joint coordinate 'knee'");
}

TEST(ModelErrors, MimicsInACircle) {
  SceneBuilder builder = arm();
  builder.body("hand", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("wrist", JointKind::Revolute, "arm", "hand").mimic = scene::Mimic{"hinge", 1, 0};
  EXPECT_NO_THROW(build_model(builder.scene));
  builder.scene.joints[0].mimic = scene::Mimic{"wrist", 1, 0};
  expect_error(builder.scene, "the mimicked joints form a circle");
  builder.scene.joints[0].mimic = scene::Mimic{"hinge", 1, 0};
  expect_error(builder.scene, "the mimicked joints form a circle");
}

TEST(ModelErrors, MimicOfAJointWithSeveralCoordinates) {
  SceneBuilder builder = arm();
  builder.body("hand", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("wrist", JointKind::Spherical, "arm", "hand");
  builder.scene.joints[0].mimic = scene::Mimic{"wrist", 1, 0};
  expect_error(builder.scene, "wrist");
  builder.scene.joints[0].mimic = scene::Mimic{"wrist/rx", 1, 0};
  expect_error(builder.scene, "only a joint with one coordinate can be mimicked");
}

TEST(ModelErrors, PrescribedComponentOfAFreeRotation) {
  SceneBuilder builder = arm();
  builder.body("hand", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("wrist", JointKind::Floating, "arm", "hand");
  builder.scene.motions.push_back({"wrist/x", TimeFunction(0.1), {}});
  EXPECT_NO_THROW(build_model(builder.scene));
  builder.scene.motions.push_back({"wrist/rx", TimeFunction(0.1), {"s.urdf", 9}});
  expect_error(builder.scene, "s.urdf:9: <motion>: a component of a free rotation cannot be prescribed");
}

TEST(ModelErrors, LoadOnTheWorld) {
  SceneBuilder builder = arm();
  builder.load("world", Vector3::Zero(), Vector3::UnitX());
  expect_error(builder.scene, "link 'world' is fixed to the world");
}

TEST(ModelErrors, DistributedLoadOnARigidLink) {
  SceneBuilder builder = arm();
  builder.scene.distributed_loads.push_back({"arm", Vector3::UnitX(), scene::LoadFrame::World, TimeFunction(), {}});
  expect_error(builder.scene, "link 'arm' has no <beam>");
}

TEST(ModelErrors, ImpossibleBeams) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0), Vector3(0.5, 0, 0)}, section(1, 1, 1, 1, 1, 1, 1), 2, 2).location = {"s.urdf",
                                                                                                               5};
  builder.joint("clamp", JointKind::Fixed, "world", "beam");
  expect_error(builder.scene, "s.urdf:5: <centerline> of link 'beam': centreline reverses");
  builder.scene.links.back().beam->centreline.pop_back();
  EXPECT_NO_THROW(build_model(builder.scene));
  for (const int order : {0, 5}) {
    builder.scene.links.back().beam->order = order;
    expect_error(builder.scene, "order must be 1 to 4");
  }
}

}  // namespace
}  // namespace flexarm
