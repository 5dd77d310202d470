// Compares the tangent of a step with differences of the residual, for springs, motors behind rigid and elastic gears,
// servos, and gyroscopic rotors.
#include "integrators/scheme_step.h"

namespace flexarm {
namespace {

using namespace test;

/// A scene with motors on a hinge and a slider, on rigid and flexible links. The gears are rigid or elastic, with
/// backlash and losses.
scene::SceneDescription driven_scene(bool is_elastic) {
  scene::SceneDescription scene = every_joint_scene(false);
  for (auto* joints : {&scene.joints, &scene.loop_joints})
    for (scene::JointDescription& joint : *joints) joint.friction = 0;  // its slope is tested in friction_tangent_test
  for (const char* joint : {"shoulder", "slider"}) {
    scene::DriveDescription drive;
    drive.coordinate = joint;
    drive.gear = 5;
    drive.rotor_inertia = 0.02;
    drive.efficiency = 0.8;
    if (is_elastic) {
      drive.stiffness = 30;
      drive.damping = 0.4;
      drive.backlash = 0.05;
      drive.friction = 0.3;
    }
    scene.drives.push_back(drive);
    scene.springs.push_back({joint, 7, 0.2, {}});
    scene::ServoDescription servo;
    servo.coordinate = joint;
    servo.kp = 12;
    servo.kd = 1.5;
    servo.ki = 3;
    servo.set_point = TimeFunction::parse("0.1+t");
    servo.side =
        joint == std::string("slider") ? scene::ServoDescription::Side::Link : scene::ServoDescription::Side::Motor;
    scene.servos.push_back(servo);
  }
  return scene;
}

class ActuatorTangent : public SchemeStep {
 protected:
  /// Compares tangent and differences, with updates so short that no gear enters or leaves its backlash.
  void expect_consistent(const Model& model) const {
    RandomSource random(21);
    StepSystem system(model, scheme(), BackendChoice::Matrix);
    State state = prepared(random_state(model, random, 0.15), system, random);
    for (ActuatorState& actuator : state.actuators) actuator.rate = random.number(), actuator.angle += 0.3;
    system.begin(state, 0.2, Guess::Extrapolated);
    system.update(random_update(system.degrees_of_freedom().unknowns, random, 0.1));
    expect_consistent_tangent(system, 0.03);
  }
};

TEST_P(ActuatorTangent, RigidGears) {
  expect_consistent(build_model(driven_scene(false)));
}

TEST_P(ActuatorTangent, ElasticGears) {
  expect_consistent(build_model(driven_scene(true)));
}

TEST_P(ActuatorTangent, Gyroscopes) {
  if (!scheme().is_incremental()) GTEST_SKIP() << "refuses rotors with an axis";
  for (const bool is_elastic : {false, true}) {
    scene::SceneDescription scene = driven_scene(is_elastic);
    for (scene::DriveDescription& drive : scene.drives) drive.axis = Vector3(0.6, 0, 0.8);
    for (scene::JointDescription& joint : scene.joints)
      // So that the base carries the shoulder's motor around
      if (joint.name == "base") joint.kind = scene::JointKind::Spherical;
    expect_consistent(build_model(scene));
  }
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, ActuatorTangent, ::testing::ValuesIn(with_consistent_tangent()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm
