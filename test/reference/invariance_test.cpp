// Tests that the orientation of the scene in space, and a weld within a beam, do not change results.
#include "math/pi.h"
#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A tree with flexible and rigid links on several joints, in free flight or hung up, under gravity and dead and
/// follower loads. The whole scene is rotated by `rotation` about the world's origin.
SceneBuilder turned_scene(const Quaternion& rotation, bool hung_up) {
  SceneBuilder b = free_tree(JointKind::Universal);
  b.load("branch", {0.5, 2, 0.3}, {1, 2, 3}, {0.1, 0.2, 0.3}, "sin(t)");
  b.load("trunk", {2, 0, 0}, {0, 1, 0}, {0, 0, 0.2}, "1", scene::LoadFrame::Follower);
  b.scene.distributed_loads.push_back({"trunk", {0.2, 0, 0.1}, scene::LoadFrame::World, TimeFunction(), {}});
  b.scene.gravity = {0.5, 0, -2};
  b.probe("hand", "hand", {0.1, 0.2, 0.3});
  b.probe("span", "trunk", {1.2, 0, 0});
  if (hung_up) {
    b.scene.joints[0].kind = JointKind::Revolute;
    b.scene.joints[0].axis = Vector3(2, 1, 2) / 3;
    b.scene.initial_links.clear();
    initial_joint(b, "free", 0, 0.7);
  }
  const auto turn = [&](Vector3& v) { v = rotation * v; };
  scene::JointDescription& root = b.scene.joints[0];
  root.origin.position = Vector3(0.3, -0.1, 0.2);
  root.origin = Pose{Vector3::Zero(), rotation} * root.origin;
  turn(b.scene.gravity);
  for (scene::InitialLink& field : b.scene.initial_links) turn(field.linear), turn(field.angular);
  for (scene::PointLoad& load : b.scene.loads)
    if (load.frame == scene::LoadFrame::World) turn(load.force), turn(load.moment);
  for (scene::DistributedLoad& load : b.scene.distributed_loads)
    if (load.frame == scene::LoadFrame::World) turn(load.force);
  return b;
}

class Rotated : public ::testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(Rotated, SceneGivesTheRotatedAnswer) {
  const auto [scheme, hung_up] = GetParam();
  for (const Vector3& axis : {Vector3(1, 2, -2), Vector3(0, 0, 1), Vector3(1, 0, 0)}) {
    const Quaternion rotation(Eigen::AngleAxisd(axis.x() == 0 ? kPi : 2.3, axis.normalized()));
    Simulation plain(turned_scene(Quaternion::Identity(), hung_up).scene, options(scheme, 0.02, 1e-11));
    Simulation turned(turned_scene(rotation, hung_up).scene, options(scheme, 0.02, 1e-11));
    for (int n = 0; n < 150; ++n) {
      ASSERT_TRUE(plain.step().converged);
      ASSERT_TRUE(turned.step().converged);
      for (int k = 0; k < 2; ++k) {
        const ProbeState a = plain.probe(k), b = turned.probe(k);
        ASSERT_LT((rotation * a.pose.position - b.pose.position).norm(), 1e-9) << "t = " << plain.time();
        ASSERT_LT((rotation * a.velocity - b.velocity).norm(), 1e-8) << "t = " << plain.time();
        ASSERT_LT((rotation * a.pose.orientation).angularDistance(b.pose.orientation), 1e-8) << "t = " << plain.time();
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Schemes, Rotated,
                         ::testing::Combine(::testing::Values("em", "em0", "m1", "newmark"), ::testing::Bool()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + (std::get<1>(info.param) ? "_hung_up" : "_free");
                         });

/// Adds a part of a circle of radius 2 in the x-y plane of the link, from `from` to `to` [rad], as one beam.
void quarter_piece(SceneBuilder& b, const std::string& name, double from, double to, int elements, int order) {
  const auto point = [](double angle) { return Vector3(2 * std::sin(angle), 2 - 2 * std::cos(angle), 0); };
  scene::BeamDescription& beam = b.beam(name, {point(to) - point(from)}, soft_section(), elements, order);
  beam.centreline[0].kind = scene::CentrelinePiece::Kind::Arc;
  beam.centreline[0].center = Vector3(0, 2, 0) - point(from);
  beam.section_y = Vector3::UnitZ();
  beam.stiffness_proportional_damping = 1e-3;
}

/// A quarter circle in one piece, or welded from two pieces at a third of its length.
SceneBuilder curved_beam(bool welded, JointKind root, int order) {
  SceneBuilder b;
  const double split = kPi / 6, end = kPi / 2;
  const Vector3 tip(2, 2, 0), border(2 * std::sin(split), 2 - 2 * std::cos(split), 0);
  b.scene.gravity = {0, 0, -1};
  if (welded) {
    quarter_piece(b, "first", 0, split, 1, order);
    quarter_piece(b, "second", split, end, 2, order);
    b.joint("root", root, "world", "first");
    b.joint("weld", JointKind::Fixed, "first", "second", border);
    b.probe("tip", "second", tip - border);
    b.probe("middle", "first", border);
    b.load("second", tip - border, {1, 2, 3}, {0.1, 0.2, 0.5}, "sin(t)");
  } else {
    quarter_piece(b, "first", 0, end, 3, order);
    b.joint("root", root, "world", "first");
    b.probe("tip", "first", tip);
    b.probe("middle", "first", border);
    b.load("first", tip, {1, 2, 3}, {0.1, 0.2, 0.5}, "sin(t)");
  }
  return b;
}

class Welded : public ::testing::TestWithParam<std::tuple<std::string, JointKind>> {};

TEST_P(Welded, BeamMovesAsOne) {
  const auto [scheme, root] = GetParam();
  for (int order = 1; order <= 4; ++order) {
    Simulation one(curved_beam(false, root, order).scene, options(scheme, 0.02, 1e-11));
    Simulation two(curved_beam(true, root, order).scene, options(scheme, 0.02, 1e-11));
    ASSERT_EQ(one.degrees_of_freedom(), two.degrees_of_freedom()) << "a weld has no unknowns";
    for (int n = 0; n < 150; ++n) {
      ASSERT_TRUE(one.step().converged);
      ASSERT_TRUE(two.step().converged);
      for (int k = 0; k < 2; ++k) {
        const ProbeState a = one.probe(k), b = two.probe(k);
        ASSERT_LT((a.pose.position - b.pose.position).norm(), 1e-9) << "order " << order << ", t = " << one.time();
        ASSERT_LT(a.pose.orientation.angularDistance(b.pose.orientation), 1e-8);
      }
    }
    EXPECT_NEAR(one.energies().total(), two.energies().total(), 1e-9 * (1 + std::abs(one.energies().total())));
  }
}
INSTANTIATE_TEST_SUITE_P(Schemes, Welded,
                         ::testing::Combine(::testing::Values("em", "em0", "m1", "newmark"),
                                            ::testing::Values(JointKind::Fixed, JointKind::Floating)),
                         [](const auto& info) {
                           return std::get<0>(info.param) +
                                  (std::get<1>(info.param) == JointKind::Fixed ? "_clamped" : "_free");
                         });

}  // namespace
}  // namespace flexarm::test
