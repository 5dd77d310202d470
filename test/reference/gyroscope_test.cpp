// Tests gyroscopes, i.e. rotors with an axis, against spinning bodies and by conserved quantities.
#include <cmath>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// A frame on a ball joint carries a spinning wheel on its axis z, and a pendulum weight. With `is_rotor`, the wheel's
/// inertia about the axis belongs to the drive.
SceneBuilder gyroscope(bool is_rotor, double spin) {
  const double axial = 0.02;
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.beam("stem", {{0, 0, 0.4}}, scene::DirectSection{2e4, 1e4, 1e4, 60, 80, 90, 0.3, 2e-4, 1e-4, 1e-4}, 2, 2);
  b.joint("ball", JointKind::Spherical, "world", "stem", {0, 0, 0});
  b.body("housing", 0.8, {0, 0, 0.05}, Vector3(0.01, 0.012, 0.008).asDiagonal());
  b.joint("weld", JointKind::Fixed, "stem", "housing", {0, 0, 0.4});
  b.body("wheel", 0.5, {0, 0, 0}, Vector3(0.006, 0.006, is_rotor ? 1e-5 : axial).asDiagonal());
  b.joint("shaft", JointKind::Revolute, "housing", "wheel", {0, 0, 0.1}, {0, 0, 1});
  initial_joint(b, "ball/ry", 0.5, 0);
  initial_joint(b, "shaft", 0, spin);
  if (is_rotor) {
    scene::DriveDescription& drive = b.drive("shaft", 1, axial - 1e-5);
    drive.axis = Vector3::UnitZ();
  }
  return b;
}

// A rotor with an axis acts as a wheel on its parent: precession and nutation of a flexible top agree with those of a
// spinning body.
TEST(Gyroscope, AgreesWithASpinningBody) {
  for (const char* scheme : {"em", "m1", "std"}) {
    double error[2];
    for (const int k : {0, 1}) {
      const int steps = 500 << k;
      Simulation rotor(gyroscope(true, 60).scene, options(scheme, 0.5 / steps, 1e-11)),
          body(gyroscope(false, 60).scene, options(scheme, 0.5 / steps, 1e-11));
      run(rotor, steps);
      run(body, steps);
      error[k] = (rotor.link_pose(3).position - body.link_pose(3).position).norm();
      EXPECT_GT((rotor.link_pose(3).position - Simulation(gyroscope(true, 60).scene).link_pose(3).position).norm(),
                0.05)
          << "it precesses";
      EXPECT_NEAR(rotor.energies().kinetic, body.energies().kinetic, 1e-3 * body.energies().kinetic);
    }
    // The wheel's increments are tangent-scaled, the rotor's are not. Both have errors of second order.
    EXPECT_LT(error[1], 2e-4) << scheme;
    EXPECT_GT(std::log2(error[0] / error[1]), 1.7) << scheme;
  }
}

// Without gravity, and with a motor that acts between frame and rotor, energy account and angular momentum stay
// constant.
TEST(Gyroscope, KeepsEnergyAndAngularMomentum) {
  for (const bool is_elastic : {false, true}) {
    SceneBuilder b;
    b.body("frame", 1.5, {0.05, 0.02, 0}, Vector3(0.03, 0.05, 0.06).asDiagonal());
    b.joint("flight", JointKind::Floating, "world", "frame");
    b.beam("arm", {{0.5, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 60, 80, 90, 0.3, 2e-4, 1e-4, 1e-4}, 2, 2);
    b.joint("shoulder", JointKind::Revolute, "frame", "arm", {0.1, 0, 0}, {0, 1, 0});
    b.body("hand", 0.4, {0.1, 0.03, 0}, Vector3(2e-3, 3e-3, 2e-3).asDiagonal());
    b.joint("elbow", JointKind::Revolute, "arm", "hand", {0.5, 0, 0}, {0, 0.6, 0.8});
    for (const char* joint : {"shoulder", "elbow"}) {
      scene::DriveDescription& drive = b.drive(joint, 50, 2e-5);
      drive.axis = Vector3(0.6, 0, 0.8);
      if (is_elastic) drive.stiffness = 400, drive.backlash = 1e-3;
    }
    initial_field(b, "frame", {0, 0, 0}, {1, -2, 3});
    b.scene.initial_joints.push_back({"shoulder", 0.3, 2, {}, true});
    b.scene.initial_joints.push_back({"elbow", 0.3, -3, {}, true});
    b.scene.efforts.push_back({"shoulder", TimeFunction::parse("3*sin(9*t)"), {}});
    b.scene.efforts.push_back({"elbow", TimeFunction::parse("cos(7*t)"), {}});
    Simulation simulation(b.scene, full_newton(options("em", 2e-3, 1e-13)));
    InvariantDrift drift(simulation);
    run(simulation, 1500, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), 1e-10);
    EXPECT_LT(drift.angular_momentum(), 1e-10);
    EXPECT_LT(drift.momentum(), 1e-10);
  }
}

TEST(Gyroscope, IsRefusedWhereItIsNotKnown) {
  EXPECT_THROW(Simulation(gyroscope(true, 60).scene, options("newmark", 1e-3)), ModelError);
  SceneBuilder b = gyroscope(true, 60);
  b.scene.drives[0].stiffness = 100;
  for (scene::JointDescription& joint : b.scene.joints)
    joint.friction_law.law = scene::FrictionDescription::Law::Coulomb;
  EXPECT_THROW(Simulation(b.scene), ModelError);
}

}  // namespace
}  // namespace flexarm::test
