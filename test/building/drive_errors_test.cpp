// Tests errors of springs, drives and servos that are impossible.
#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A hinge, a ball joint, and a hinge that mimics the first one.
SceneBuilder joints() {
  SceneBuilder b;
  for (const char* body : {"upper", "lower", "hand"}) b.body(body, 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "world", "upper");
  b.joint("ball", JointKind::Spherical, "upper", "lower");
  b.joint("follower", JointKind::Revolute, "lower", "hand").mimic = scene::Mimic{"hinge", 2, 0};
  return b;
}

template <class Description>
Description at(const std::string& coordinate) {
  Description out;
  out.coordinate = coordinate;
  out.location = {"arm.urdf", 7};
  return out;
}

TEST(DriveErrors, OfCoordinates) {
  for (const auto& [coordinate, why] :
       {std::pair("ball/rx", "turn or fly freely"), std::pair("follower", "follows another coordinate"),
        std::pair("nobody", "there is no joint coordinate")}) {
    SceneBuilder spring = joints(), drive = joints(), servo = joints();
    spring.scene.springs.push_back(at<scene::SpringDescription>(coordinate));
    drive.scene.drives.push_back(at<scene::DriveDescription>(coordinate));
    servo.scene.servos.push_back(at<scene::ServoDescription>(coordinate));
    for (const auto& [scene, element] :
         {std::pair(spring.scene, "<spring>"), std::pair(drive.scene, "<drive>"), std::pair(servo.scene, "<servo>")}) {
      expect_error(scene, why);
      expect_error(scene, std::string("arm.urdf:7: ") + element);
    }
  }
}

TEST(DriveErrors, OfMotions) {
  SceneBuilder drive = joints(), servo = joints();
  drive.scene.drives.push_back(at<scene::DriveDescription>("hinge"));
  servo.scene.servos.push_back(at<scene::ServoDescription>("hinge"));
  for (SceneBuilder* b : {&drive, &servo}) {
    b->scene.motions.push_back({"hinge", TimeFunction(0.0), {}});
    expect_error(b->scene, "the motion of 'hinge' is prescribed");
  }
}

TEST(DriveErrors, OfSampleTimes) {
  for (const double sample_time : {0.0025, 0.0005}) {
    SceneBuilder b = joints();
    b.scene.integrator.step = 0.001;
    b.scene.servos.push_back(at<scene::ServoDescription>("hinge"));
    b.scene.servos.back().sample_time = sample_time;
    expect_error(b.scene, "sample_time must be a multiple of the step, 0.001 s");
  }
}

}  // namespace
}  // namespace flexarm::test
