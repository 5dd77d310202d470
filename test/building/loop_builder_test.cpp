// Tests models with loops.
#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "building/model_builder.h"
#include "building/places_at_start.h"
#include "joints/closure_maps.h"
#include "joints/joint_kinematics.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A rigid crank, a flexible coupler and a rigid rocker that hangs from the world, with hinges about y. The loop is
/// closed between the coupler's free tip and the rocker's end.
SceneBuilder crank_rocker() {
  SceneBuilder b;
  b.body("crank", 1, {0, 0, 0.2}, Matrix3::Identity());
  b.beam("coupler", {{1, 0, 0.2}}, section(1e4, 1e4, 100, 100, 1, 0.1, 0.1), 2, 2);
  b.body("rocker", 1, {0, 0, 0.3}, Matrix3::Identity());
  b.joint("ground", JointKind::Continuous, "world", "crank", {0, 0, 0}, {0, 1, 0});
  b.joint("knee", JointKind::Continuous, "crank", "coupler", {0, 0, 0.4}, {0, 1, 0});
  b.joint("foot", JointKind::Continuous, "world", "rocker", {1, 0, 0}, {0, 1, 0});
  return b;
}

SceneBuilder closed_crank_rocker() {
  SceneBuilder b = crank_rocker();
  close_loop(b, "hip", JointKind::Continuous, "rocker", "coupler", {1, 0, 0.2}, {0, 1, 0}).location = {"s.urdf", 17};
  return b;
}

const Coordinate& coordinate(const Model& model, const std::string& name) {
  for (const Coordinate& c : model.coordinates)
    if (c.name == name) return c;
  ADD_FAILURE() << name;
  return model.coordinates.front();
}

/// Expects that every joint's master is known before its slave, and that no node is a slave twice.
void expect_root_to_leaf(const Model& model) {
  std::vector<bool> is_slave(model.nodes.size(), false), is_known(model.nodes.size(), false);
  for (const JointMap& joint : model.joints) {
    EXPECT_FALSE(is_slave[joint.slave]);
    is_slave[joint.slave] = true;
  }
  for (const JointMap& joint : model.joints) {
    EXPECT_TRUE(joint.master < 0 || is_known[joint.master] || !is_slave[joint.master]);
    is_known[joint.slave] = true;
  }
  std::vector<NodePose> poses = model.nodes;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const NodePose pose = slave_pose(model, static_cast<int>(j), poses, model.initial_released[j]);
    EXPECT_LT((pose.position - model.nodes[model.joints[j].slave].position).norm(), 1e-15);
    EXPECT_LT((pose.rotation - model.nodes[model.joints[j].slave].rotation).norm(), 1e-15);
  }
}

TEST(LoopBuilder, TipBecomesASlave) {
  const Model open = build_model(crank_rocker().scene), model = build_model(closed_crank_rocker().scene);
  EXPECT_EQ(model.nodes.size(), open.nodes.size() + 1) << "the node in the moved joint frame";
  EXPECT_EQ(model.joints.size(), open.joints.size() + 2);
  expect_root_to_leaf(model);
  ASSERT_EQ(model.coordinates.size(), 4u);
  EXPECT_EQ(model.coordinates.back().name, "hip");
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    const Coordinate& c = model.coordinates[i];
    EXPECT_EQ(model.joints[c.joint].kind, JointMapKind::Scalar);
    EXPECT_EQ(model.first_coordinate[c.joint], static_cast<int>(i));
  }
  const JointMap& hip = model.joints[coordinate(model, "hip").joint];
  EXPECT_EQ(hip.master, model.links[3].frame.node);
  EXPECT_EQ(hip.rotation, Vector3::UnitY());
}

// Links on the tip move with it: their joints come after the closing joint, whatever the order in the scene.
TEST(LoopBuilder, JointsAreSortedRootToLeaf) {
  SceneBuilder b = crank_rocker();
  b.body("lamp", 1, {0.1, 0, 0.1}, Matrix3::Identity());
  b.joint("lamp", JointKind::Universal, "coupler", "lamp", {1, 0, 0.3}).axis2 = Vector3::UnitX();
  std::rotate(b.scene.joints.begin(), b.scene.joints.begin() + 2, b.scene.joints.end());  // now the rocker is last
  std::swap(b.scene.joints[0], b.scene.joints[3]);
  close_loop(b, "hip", JointKind::Cylindrical, "rocker", "coupler", {1, 0, 0.2}, {0, 1, 0});
  const Model model = build_model(b.scene);
  expect_root_to_leaf(model);
  for (const char* name : {"lamp/2", "hip/1", "hip/2"}) EXPECT_EQ(coordinate(model, name).name, name);
  EXPECT_LT(coordinate(model, "hip/2").joint, coordinate(model, "lamp/1").joint);
  EXPECT_EQ(coordinate(model, "hip/1").joint + 1, coordinate(model, "hip/2").joint);
  EXPECT_EQ(model.joints[coordinate(model, "hip/1").joint].translation, Vector3::UnitY());
}

// If a rigid body is fixed to the tip, and another one to this body, they hold the tip's node.
TEST(LoopBuilder, BodiesFixedToATipAreHeldByItsNode) {
  SceneBuilder b = crank_rocker();
  b.body("arm", 1, {0.1, 0, 0.1}, Matrix3::Identity());
  b.body("hand", 1, {0.1, 0, 0.1}, Matrix3::Identity());
  b.joint("arm", JointKind::Fixed, "coupler", "arm", {1, 0.2, 0.2}).origin.orientation =
      Eigen::AngleAxisd(0.7, Vector3(0.6, 0.8, 0));
  b.joint("hand", JointKind::Fixed, "arm", "hand", {0, 0, 0.3});
  const int tip = build_model(b.scene).links[2].beam->tip.node;
  for (const bool exchanged : {false, true}) {
    SceneBuilder closed = b;
    scene::JointDescription& loop = close_loop(closed, "hip", JointKind::Revolute, "rocker", "hand", {0.1, 0.1, 0.1});
    if (exchanged) {
      std::swap(loop.parent, loop.child);
      std::swap(loop.origin, loop.child_origin);
    }
    const Model model = build_model(closed.scene);
    expect_root_to_leaf(model);
    const JointMap& hip = model.joints[coordinate(model, "hip").joint];
    EXPECT_EQ(hip.master, model.links[3].frame.node);
    // The axis is the z axis of the joint's frame in the parent, reversed if the parent is the slave.
    const LinkFrame& parent = model.links[exchanged ? 5 : 3];
    ASSERT_EQ(parent.name, loop.parent);
    const Quaternion frame = model.nodes[parent.frame.node].orientation * parent.frame.offset.orientation;
    const Vector3 axis = frame * loop.origin.orientation * Vector3((exchanged ? -1 : 1) * Vector3::UnitZ());
    EXPECT_LE((model.nodes[hip.master].rotation * hip.rotation - axis).norm(), 1e-15);
    int held = -1;
    for (const JointMap& joint : model.joints)
      if (joint.master == hip.slave) held = joint.slave;
    EXPECT_EQ(held, tip);
  }
}

TEST(LoopBuilder, VelocitiesOfTheStartAgreeWithTheLoop) {
  SceneBuilder b = closed_crank_rocker();
  b.scene.initial_joints.push_back({"ground", 0, 2, {}});
  for (const bool given : {false, true}) {
    if (given) b.scene.initial_joints.push_back({"hip", 0, -3, {}});
    const Model model = build_model(b.scene);
    std::vector<double> rates;
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointMap& joint = model.joints[j];
      Vector6 remainder;
      const ReleasedVector rate =
          released_rates(joint, joint_pose(joint, model.nodes, model.initial_released[j]),
                         joint.master < 0 ? Vector6(Vector6::Zero()) : model.initial_velocity[joint.master],
                         model.initial_velocity[joint.slave], &remainder);
      EXPECT_LT(remainder.norm(), 1e-14);
      rates.insert(rates.end(), rate.data(), rate.data() + rate.size());
    }
    const auto rate = [&](const char* name) { return rates[coordinate(model, name).joint]; };
    EXPECT_NEAR(rates[0], 2, 1e-14);
    // Without an initial rate of the closing joint, the tip moves with its beam.
    const int j = coordinate(model, "hip").joint;
    const Vector6& tip = model.initial_velocity[model.joints[j].slave];
    EXPECT_NEAR(tip[4], given ? -3 : 2, 1e-14);
    (void)rate;
  }
}

TEST(LoopBuilder, OpenAtTheStart) {
  SceneBuilder b = closed_crank_rocker();
  b.scene.loop_joints[0].origin.position.x() += 0.02;
  expect_error(b.scene,
               "s.urdf:17: <loop_joint> 'hip': the loop is open at the start: the joint's frames in parent and child "
               "are 0.020000 m apart");
  b.scene.loop_joints[0].origin.position.x() -= 0.02 - 1e-7;
  const Model model = build_model(b.scene);
  EXPECT_TRUE(open_loops(b.scene, model).empty());
  b.scene.loop_joints[0].origin.position.x() += 2e-4 * model.length_scale;
  expect_error(b.scene, "the loop is open at the start");
}

/// A parallelogram of rigid links; the place of the loop joint on the rocker is off by `gap` along x.
SceneBuilder parallelogram_open_by(double gap) {
  SceneBuilder b;
  b.body("crank", 1, {0, 0, 0.25}, Matrix3::Identity());
  b.body("rocker", 1, {0, 0, 0.25}, Matrix3::Identity());
  b.body("coupler", 1, {0.15, 0, 0}, Matrix3::Identity());
  b.joint("a", JointKind::Continuous, "world", "crank", {0, 0, 0}, {0, 1, 0});
  b.joint("b", JointKind::Continuous, "world", "rocker", {0.3, 0, 0}, {0, 1, 0});
  b.joint("c", JointKind::Continuous, "crank", "coupler", {0, 0, 0.5}, {0, 1, 0});
  scene::JointDescription loop = b.scene.joints.back();
  loop.name = "d";
  loop.parent = "coupler", loop.child = "rocker";
  loop.origin.position = {0.3, 0, 0};
  loop.child_origin.position = {gap, 0, 0.5};
  loop.location = {"s.urdf", 17};
  b.scene.loop_joints.push_back(loop);
  return b;
}

TEST(LoopBuilder, ClosesASmallGapOnTheChild) {
  const SceneBuilder b = parallelogram_open_by(1e-5);
  const Model model = build_model(b.scene);
  const scene::Diagnostics told = open_loops(b.scene, model);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].text(),
            "s.urdf:17: warning: <loop_joint> 'd': the loop is open at the start; its place on link 'rocker' is moved "
            "to close it, got '1e-05' m");
  const Model closed = build_model(parallelogram_open_by(0).scene);
  ASSERT_EQ(model.closures.size(), 1u);
  EXPECT_LT((model.closures[0].child_arm - closed.closures[0].child_arm).norm(), 1e-15);
  EXPECT_LT((model.closures[0].parent_arm - closed.closures[0].parent_arm).norm(), 1e-15);
}

TEST(LoopBuilder, NothingStartsElsewhere) {
  SceneBuilder b = closed_crank_rocker();
  b.scene.initial_joints.push_back({"hip", 0.1, 0, {}});
  expect_error(b.scene, "its coordinates are 0 at the start; 'hip' cannot start elsewhere");
}

TEST(LoopBuilder, KindsThatCloseNothing) {
  for (const JointKind kind : {JointKind::Slide, JointKind::Floating}) {
    SceneBuilder b = closed_crank_rocker();
    b.scene.loop_joints[0].kind = kind;
    b.scene.loop_joints[0].slide.emplace();
    expect_error(b.scene, "a loop cannot be closed by");
  }
}

// A travel across the axis cannot be inverted.
TEST(LoopBuilder, PinionNeedsTheChildsEnd) {
  SceneBuilder b = crank_rocker();
  scene::JointDescription& loop =
      close_loop(b, "hip", JointKind::RackAndPinion, "rocker", "coupler", {1, 0, 0.2}, {0, 1, 0});
  loop.ratio = 0.1;
  loop.direction = Vector3::UnitX();
  loop.origin.position -= 0.1 * loop.direction.cross(loop.axis);
  EXPECT_NO_THROW(build_model(b.scene));
  std::swap(loop.parent, loop.child);
  std::swap(loop.origin, loop.child_origin);
  loop.child_origin.position += 0.1 * loop.direction.cross(loop.axis);
  loop.origin.position -= 0.1 * loop.direction.cross(loop.axis);
  expect_error(b.scene, "exchange <parent> and <child>");
}

// ---------------------------------------------------------------- loops of rigid links

/// The crank-rocker with a rigid coupler, whose loop is closed by multipliers.
SceneBuilder rigid_crank_rocker(JointKind closing = JointKind::Continuous) {
  SceneBuilder b = crank_rocker();
  b.scene.links[2].beam.reset();
  b.scene.links[2].inertial = scene::RigidInertia{1, {0.5, 0, 0.1}, Matrix3::Identity()};
  close_loop(b, "hip", closing, "rocker", "coupler", {1, 0, 0.2}, {0, 1, 0}).location = {"s.urdf", 17};
  return b;
}

TEST(RigidLoopBuilder, KeepsIndependentConstraints) {
  const std::tuple<JointKind, int, int> kinds[] = {
      {JointKind::Continuous, 2, 5}, {JointKind::Spherical, 2, 3}, {JointKind::Universal, 2, 4}};
  for (const auto& [kind, kept, all] : kinds) {
    SceneBuilder b = rigid_crank_rocker(kind);
    const Model model = build_model(b.scene);
    ASSERT_EQ(model.closures.size(), 1u);
    EXPECT_EQ(model.closures[0].constraints.size(), static_cast<std::size_t>(kept));
    EXPECT_EQ(model.closures[0].implied.size(), static_cast<std::size_t>(all - kept));
    EXPECT_EQ(model.coordinates.size(), 3u) << "the closing joint has none";
    for (const auto* list : {&model.closures[0].constraints, &model.closures[0].implied})
      for (const ClosureConstraint& constraint : *list)
        EXPECT_NEAR(closure_value(model.closures[0], constraint,
                                  {model.nodes[model.closures[0].parent], model.nodes[model.closures[0].child]}),
                    0, 1e-15);
  }
}

/// Initial velocity of a node's point at `arm` in the node's frame.
Vector3 velocity_at(const Model& model, int node, const Vector3& arm) {
  const Vector6& velocity = model.initial_velocity[node];
  return velocity.head<3>() + Vector3(velocity.tail<3>()).cross(model.nodes[node].rotation * arm);
}

TEST(RigidLoopBuilder, RatesOfTheOtherJointsFollow) {
  SceneBuilder b = rigid_crank_rocker();
  b.scene.initial_joints.push_back({"ground", 0, 2, {}});
  const Model model = build_model(b.scene);
  // The crank's end is at (0, 0.4), the rocker's at (1, 0.6) from (1, 0), in the x-z plane: v = w x r about +y.
  const LoopClosure& closure = model.closures[0];
  const Vector6 &rocker = model.initial_velocity[closure.parent], &coupler = model.initial_velocity[closure.child];
  EXPECT_NEAR(
      (velocity_at(model, closure.parent, closure.parent_arm) - velocity_at(model, closure.child, closure.child_arm))
          .norm(),
      0, 1e-12);
  // v = (0.8, 0) + w (0.2, -1) = W (0.6, 0): the coupler does not rotate, w = 0.
  EXPECT_NEAR(coupler[4], 0, 1e-12);
  EXPECT_NEAR(rocker[4], 0.8 / 0.6, 1e-12);
  b.scene.initial_joints.push_back({"foot", 0, 1, {}});
  expect_error(b.scene, "<loop_joint> 'hip': the initial velocities of the joints contradict the loop that it closes");
}

// An axis with rounded numbers is not quite parallel to the others, so that constraints that count as implied open by
// as little. The others must hold.
TEST(RigidLoopBuilder, RatesAreThoseOfParallelAxesIfNumbersAreRounded) {
  SceneBuilder b = rigid_crank_rocker();
  b.scene.initial_joints.push_back({"ground", 0, 2, {}});
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.name == "foot") joint.axis = {3e-7, 1, 0};
  const Model model = build_model(b.scene);
  ASSERT_EQ(model.closures[0].constraints.size(), 2u);
  EXPECT_NEAR(model.initial_velocity[model.closures[0].child][4], 0, 1e-6);
  EXPECT_NEAR(model.initial_velocity[model.closures[0].parent][4], 0.8 / 0.6, 1e-6);
}

TEST(RigidLoopBuilder, EachOfSeveralLoopsIsClosedAsIfAlone) {
  // A second linkage, either on the world, where the loops have nothing in common, or on the first coupler.
  for (const char* base : {"world", "coupler"}) {
    SceneBuilder b = rigid_crank_rocker();
    const scene::SceneDescription one = b.scene;
    const auto second = [&](const std::string& link) { return link == "world" ? std::string(base) : link + "2"; };
    for (scene::LinkDescription link : one.links)
      if (link.name != one.root_link) link.name += "2", b.scene.links.push_back(link);
    for (const auto& [from, to] : {std::pair(&one.joints, &b.scene.joints), {&one.loop_joints, &b.scene.loop_joints}})
      for (scene::JointDescription joint : *from) {
        joint.name += "2";
        joint.parent = second(joint.parent), joint.child = second(joint.child);
        to->push_back(joint);
      }
    b.scene.initial_joints = {{"ground", 0, 2, {}}, {"ground2", 0, -1, {}}};
    const Model model = build_model(b.scene);
    ASSERT_EQ(model.closures.size(), 2u) << base;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(model.closures[k].constraints.size(), 2u) << base << k;
      EXPECT_EQ(model.closures[k].implied.size(), 3u) << base << k;
    }
    // As for one loop: v = (0.8, 0) + w (0.2, -1) = W (0.6, 0) if the crank's rate is 2. The coupler does not rotate.
    for (const auto& [closure, rate] : {std::pair(model.closures[0], 2.0), {model.closures[1], -1.0}}) {
      EXPECT_NEAR(model.initial_velocity[closure.child][4], 0, 1e-12) << base;
      EXPECT_NEAR(model.initial_velocity[closure.parent][4], rate * 0.4 / 0.6, 1e-12) << base;
    }
    b.scene.initial_joints.push_back({"foot2", 0, 1, {}});
    expect_error(b.scene,
                 "<loop_joint> 'hip': the initial velocities of the joints contradict the loop that it closes");
  }
}

TEST(RigidLoopBuilder, WhatHasNoCoordinateIsRefused) {
  const auto expect = [](const auto& change, const std::string& message) {
    SceneBuilder b = rigid_crank_rocker();
    change(b.scene);
    expect_error(b.scene, message);
  };
  const std::string no_coordinate =
      "s.urdf:17: <loop_joint> 'hip': closes a loop of rigid links, so that it has no "
      "coordinate and cannot have damping, friction or limits";
  expect([](auto& scene) { scene.loop_joints[0].damping = 0.1; }, no_coordinate);
  expect([](auto& scene) { scene.loop_joints[0].friction = 0.1; }, no_coordinate);
  expect([](auto& scene) { scene.loop_joints[0].limits = scene::JointLimits{-1, 1}; }, no_coordinate);
  expect(
      [](auto& scene) {
        scene.efforts.push_back({"hip", TimeFunction(1), {"s.urdf", 20}});
      },
      "s.urdf:20: <effort>: joint 'hip' closes a loop of rigid links and has no coordinate: name");
  expect(
      [](auto& scene) {
        scene.motions.push_back({"hip", TimeFunction::parse("t"), {"s.urdf", 20}});
      },
      "joint 'hip' closes a loop of rigid links and has no coordinate: name");
  expect(
      [](auto& scene) {
        scene.initial_joints.push_back({"hip", 0, 1, {"s.urdf", 20}});
      },
      "joint 'hip' closes a loop of rigid links and has no coordinate: name");
  expect(
      [](auto& scene) {
        scene.loop_joints[0].kind = JointKind::Screw;
        scene.loop_joints[0].ratio = 1;
      },
      "a joint of this kind cannot close a loop of rigid links");
  expect([](auto& scene) { scene.loop_joints[0].origin.position.z() += 0.01; }, "0.010000 m apart");
  expect(
      [](auto& scene) {
        scene.loop_joints[0].parent = "coupler";
        scene.loop_joints[0].origin = scene.loop_joints[0].child_origin;
      },
      "both places belong to the same rigid body");
  const auto stick = [](auto& scene, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      scene.joints[i].friction = 1;
      scene.joints[i].friction_law.law = scene::FrictionDescription::Law::Coulomb;
    }
  };
  expect([&](auto& scene) { stick(scene, 2); },
         "<loop_joint> 'hip': in the rigid loop that it closes, more joints may stick");
  SceneBuilder one = rigid_crank_rocker();
  stick(one.scene, 1);
  EXPECT_NO_THROW(build_model(one.scene));
  expect([](auto& scene) { scene.loop_joints[0].kind = JointKind::Fixed; },
         "other loop joints the mechanism cannot move");
}

TEST(LoopBuilder, OutsideOfTheScene) {
  SceneBuilder b = closed_crank_rocker();
  b.scene.loop_joints[0].child = "nobody";
  expect_error(b.scene, "there is no link 'nobody'");
}

}  // namespace
}  // namespace flexarm::test
