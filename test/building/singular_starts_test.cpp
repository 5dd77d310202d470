// Tests starts at which accelerations, or motions, would be undetermined. They are refused with the joint's name and
// advice.
#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "building/model_builder.h"
#include "elements/random_element.h"
#include "math/pi.h"
#include "support/scene_builder.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

const Vector3 kAcross = Vector3::UnitY();

/// Massless links of 1 m on hinges about y, each bent by an angle relative to the one before, and a body at the end.
SceneBuilder massless_chain(int links, double bend, const Matrix3& inertia, const Vector3& center) {
  SceneBuilder b;
  std::string parent = "world";
  for (int i = 0; i <= links; ++i) {
    const std::string link = "link" + std::to_string(i), hinge = "hinge" + std::to_string(i);
    if (i < links)
      b.scene.links.push_back({link, {}, {}, {}});
    else
      b.body(link, 1, center, inertia);
    b.joint(hinge, JointKind::Continuous, parent, link, {i == 0 ? 0. : 1., 0, 0}, kAcross);
    if (i > 0) b.scene.initial_joints.push_back({hinge, bend, 0, {}});
    parent = link;
  }
  return b;
}

// In a plane, a body has three degrees of freedom. With more hinges, some motion has no inertia. A point has two, or
// one if the links are in line.
TEST(SingularInertia, MasslessChains) {
  const Matrix3 body = 0.1 * Matrix3::Identity(), point = Matrix3::Zero();
  const Vector3 beside(0.5, 0, 0), end(1, 0, 0);
  for (const int links : {0, 1, 2})
    EXPECT_NO_THROW(build_model(massless_chain(links, 0.7, body, beside).scene)) << links;
  for (const int links : {0, 1}) EXPECT_NO_THROW(build_model(massless_chain(links, 0.7, point, end).scene)) << links;
  EXPECT_NO_THROW(build_model(massless_chain(1, 0, body, beside).scene));
  for (const int links : {3, 4, 6})
    expect_error(massless_chain(links, 0.5, body, beside).scene, "moves nothing at the start that the joints beyond");
  expect_error(massless_chain(2, 0.7, point, end).scene, "'hinge0' moves nothing at the start");
  expect_error(massless_chain(1, 0, point, end).scene, "'hinge0' moves nothing at the start");
  expect_error(massless_chain(1, 0, point, end).scene, "start elsewhere by <initial>");
}

/// A point mass on three axes through one point, which moves it on a sphere, in two directions only. It is in the plane
/// of roll and yaw, except for their errors `off`: together these two turn the links about the line to it.
SceneBuilder wrist(double off) {
  SceneBuilder b;
  b.scene.links.push_back({"first", {}, {}, {}});
  b.scene.links.push_back({"second", {}, {}, {}});
  b.body("head", 3, {0.0185, -0.1108, 0}, Matrix3::Zero());
  b.joint("pitch", JointKind::Continuous, "world", "first", Vector3::Zero(), Vector3::UnitZ());
  b.joint("roll", JointKind::Continuous, "first", "second", Vector3::Zero(), {1, 2 * off, -off});
  b.joint("yaw", JointKind::Continuous, "second", "head", Vector3::Zero(), {off, 1, 0});
  return b;
}

// Angles of CAD are often rounded to four decimals, such as 1.5708: 4e-6 off. Roll then keeps off^2 of its inertia, in
// which digits are lost so that pitch seems to keep some. Such a start is refused, or warned of with its joints.
TEST(SingularInertia, HiddenByRoundedAngles) {
  for (const double off : {0.0, 1e-8, 3.7e-6, 1e-4, 1e-3, 0.1}) {
    try {
      const Model model = build_model(wrist(off).scene);
      const std::vector<int> hidden = coordinates_of_hidden_inertia(model);
      EXPECT_GE(hidden.size(), 2u) << off;
      EXPECT_TRUE(std::count(hidden.begin(), hidden.end(), 1) == 1 && std::count(hidden.begin(), hidden.end(), 2) == 1)
          << off << ": roll and yaw";
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find("moves nothing at the start"), std::string::npos) << error.what();
    }
  }
}

// Chains of equal links have motions with little inertia, but with digits.
TEST(SingularInertia, IsNotHiddenInChains) {
  for (const int links : {1, 2, 6, 30, 90}) {
    SceneBuilder b;
    std::string parent = "world";
    for (int i = 0; i < links; ++i) {
      b.body("link" + std::to_string(i), 1, {0.5, 0, 0}, Vector3(0, 1. / 12, 1. / 12).asDiagonal());
      b.joint("hinge" + std::to_string(i), JointKind::Continuous, parent, "link" + std::to_string(i),
              {i == 0 ? 0. : 1., 0, 0}, kAcross);
      parent = "link" + std::to_string(i);
    }
    EXPECT_TRUE(coordinates_of_hidden_inertia(build_model(b.scene)).empty()) << links;
  }
}

TEST(SingularInertia, AxesInLineWithNothingBetween) {
  RandomSource random(3);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Vector3 axis = random.unit();
    for (const bool has_ring : {false, true}) {
      SceneBuilder b;
      if (has_ring)
        b.body("ring", 1e-9, Vector3::Zero(), 1e-9 * Matrix3::Identity());
      else
        b.scene.links.push_back({"ring", {}, {}, {}});
      b.body("end", 1, random.vector(), 0.1 * Matrix3::Identity());
      b.joint("first", JointKind::Continuous, "world", "ring", random.vector(), axis);
      b.joint("second", JointKind::Continuous, "ring", "end", 2 * axis, axis);
      if (has_ring)
        EXPECT_NO_THROW(build_model(b.scene));
      else
        expect_error(b.scene, "'first' moves nothing at the start");
    }
  }
}

/// A body in two massless rings, with rotations about z, y and z.
SceneBuilder gimbal(double nutation) {
  SceneBuilder b;
  b.scene.links.push_back({"outer", {}, {}, {}});
  b.scene.links.push_back({"inner", {}, {}, {}});
  b.body("end", 1, {0, 0, 0.1}, Vector3(0.1, 0.15, 0.2).asDiagonal());
  b.joint("first", JointKind::Continuous, "world", "outer");
  b.joint("second", JointKind::Continuous, "outer", "inner", Vector3::Zero(), kAcross);
  b.joint("third", JointKind::Continuous, "inner", "end");
  b.scene.initial_joints.push_back({"second", nutation, 0, {}});
  return b;
}

// The inertia about the first axis is the body's times sin^2 of the nutation.
TEST(SingularInertia, GimbalInItsLock) {
  for (const double nutation : {1.0, 0.1, 1e-3, 1e-5}) EXPECT_NO_THROW(build_model(gimbal(nutation).scene)) << nutation;
  for (const double nutation : {0.0, 1e-8, kPi})
    expect_error(gimbal(nutation).scene, "'first' moves nothing at the start");
}

TEST(SingularInertia, IsHeldOnDemand) {
  SceneBuilder b = gimbal(0);
  b.scene.lock_massless = true;
  for (const char* joint : {"first", "third"}) {  // the drives of a held joint are removed, too
    b.scene.springs.push_back({joint, 10});
    b.scene.servos.emplace_back().coordinate = joint;
    b.scene.efforts.push_back({joint, TimeFunction(1), {}});
  }
  const Model model = build_model(b.scene);
  EXPECT_EQ(model.actuators.size(), 1u);
  EXPECT_GE(model.coordinates[0].motion, 0);
  EXPECT_LT(model.coordinates[1].motion, 0);
  EXPECT_LT(model.coordinates[2].motion, 0);
}

// A rod's inertia about its own axis is small relative to the others, in any direction of the rod.
TEST(SingularInertia, ThinRodsSpin) {
  RandomSource random(5);
  for (const double slenderness : {1e3, 1e6, 1e8}) {
    SceneBuilder b;
    const double length = 1e5, radius = length / slenderness;
    b.beam("rod", {length * random.unit()}, section(1, 1, 1, 1, 1, radius * radius / 2, radius * radius / 4), 10, 2);
    b.joint("free", JointKind::Floating, "world", "rod");
    EXPECT_NO_THROW(build_model(b.scene)) << slenderness;
  }
}

/// Cranks on a line carry a coupler that is parallel to it. All links are rotated by `angle` from this line.
SceneBuilder parallelogram(double angle, int rockers) {
  SceneBuilder b;
  const Quaternion turned(Eigen::AngleAxisd(-angle, kAcross));
  const Matrix3 inertia = 0.05 * Matrix3::Identity();
  b.body("rocker0", 1, {0.5, 0, 0}, inertia);
  b.body("coupler", 1, {1, 0, 0}, inertia);
  b.joint("foot0", JointKind::Continuous, "world", "rocker0", Vector3::Zero(), kAcross).origin.orientation = turned;
  b.joint("head0", JointKind::Continuous, "rocker0", "coupler", {1, 0, 0}, kAcross).origin.orientation =
      turned.conjugate();
  for (int i = 1; i < rockers; ++i) {
    const std::string name = "rocker" + std::to_string(i);
    const Vector3 place(2. * i / (rockers - 1), 0, 0);
    b.body(name, 1, {0.5, 0, 0}, inertia);
    b.joint("foot" + std::to_string(i), JointKind::Continuous, "world", name, place, kAcross).origin.orientation =
        turned;
    scene::JointDescription loop = b.scene.joints.back();
    loop.name = "head" + std::to_string(i);
    loop.parent = name;
    loop.child = "coupler";
    loop.origin = {Vector3(1, 0, 0), turned.conjugate()};
    loop.child_origin.position = place;
    b.scene.loop_joints.push_back(loop);
  }
  return b;
}

// A flat parallelogram may open as a parallelogram or as a crossed one. Redundant rockers are no dead point.
TEST(DeadPoints, FlatParallelogram) {
  for (const int rockers : {2, 3, 5}) {
    expect_error(parallelogram(0, rockers).scene, "its loop starts at a dead point");
    for (const double angle : {1e-3, 0.3, kPi / 2})
      EXPECT_NO_THROW(build_model(parallelogram(angle, rockers).scene)) << rockers << " " << angle;
  }
}

}  // namespace
}  // namespace flexarm
