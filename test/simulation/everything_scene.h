#pragma once
/// Scenes that contain every feature that a scene can have.

#include "support/loops.h"

namespace flexarm::test {

/// Beams of all orders, every kind of joint, dead and follower loads with expressions and tables, friction, damping,
/// limits, mimic, a loop, prescribed motion, efforts and material damping, under gravity.
inline SceneBuilder everything_scene() {
  using scene::JointKind;
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.step = 0.002;
  b.scene.contact_time = 0.02;
  const scene::DirectSection s{2e4, 1e4, 1e4, 200, 250, 300, 0.5, 0.02, 0.01, 0.01};
  const Matrix3 inertia = Vector3(0.1, 0.12, 0.15).asDiagonal();
  for (int order = 1; order <= 4; ++order) {
    scene::BeamDescription& beam = b.beam("beam" + std::to_string(order), {{0.5, 0, 0}, {0.8, 0.2, 0}}, s, 1, order);
    beam.stiffness_proportional_damping = 1e-4;
    beam.mass_proportional_damping = 0.1;
    beam.prestrain[4] = TimeFunction::parse("0.02*sin(9*t)");
  }
  const Vector3 tip(0.8, 0.2, 0);
  const std::pair<std::string, JointKind> bodies[] = {
      {"continuous", JointKind::Continuous},   {"prismatic", JointKind::Prismatic},
      {"planar", JointKind::Planar},           {"universal", JointKind::Universal},
      {"cylindrical", JointKind::Cylindrical}, {"spherical", JointKind::Spherical},
      {"floating", JointKind::Floating},       {"fixed", JointKind::Fixed},
      {"driven", JointKind::Prismatic},        {"mimicking", JointKind::Revolute}};
  for (const auto& [name, kind] : bodies) b.body(name + "_body", 0.2, {0.05, 0.02, 0.01}, 0.1 * inertia);
  b.joint("clamp", JointKind::Fixed, "world", "beam1");
  b.joint("hinge", JointKind::Revolute, "beam1", "beam2", tip, {0, 1, 0}).limits = scene::JointLimits{-0.02, 0.02};
  b.joint("weld", JointKind::Fixed, "beam2", "beam3", tip);
  b.joint("elbow", JointKind::Revolute, "beam3", "beam4", tip, {0, 0, 1}).friction = 0.2;
  int place = 0;
  for (const auto& [name, kind] : bodies) {
    const std::string parent = "beam" + std::to_string(1 + place++ % 4);
    scene::JointDescription& joint = b.joint(name, kind, parent, name + "_body", {0.5, 0, 0.1}, {0, 0.6, 0.8});
    joint.axis2 = Vector3::UnitX();
    joint.damping = 0.5;
    joint.friction = 0.05;
  }
  b.scene.joints.back().mimic = scene::Mimic{"elbow", 0.5, 0.1};
  const std::pair<std::string, JointKind> riders[] = {{"rider", JointKind::Spherical}, {"walker", JointKind::Revolute}};
  for (const auto& [name, rotation] : riders) {
    b.body(name + "_body", 0.2, {0.05, 0.02, 0.01}, 0.1 * inertia);
    scene::JointDescription& joint =
        b.joint(name, JointKind::Slide, name == "rider" ? "beam2" : "beam3", name + "_body", {0, 0, 0}, {0, 0.6, 0.8});
    joint.slide = scene::SlideDescription{0.4, rotation};
    joint.damping = 0.5;
    joint.friction = 0.05;
  }
  b.body("valve", 0.2, {0.05, 0.02, 0.01}, 0.1 * inertia);
  scene::JointDescription& cam = b.joint("cam", JointKind::Cam, "beam2", "valve", {0.5, 0, 0}, {0, 1, 0});
  cam.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.05, 0.01));
  cam.damping = 0.1;
  b.beam("strut", {{0.3, 0.2, 0}}, s, 2, 2);
  b.joint("strut", JointKind::Spherical, "beam4", "strut", {0.5, 0, 0});
  scene::JointDescription& loop = close_loop(b, "loop", JointKind::Universal, "beam4", "strut", {0.3, 0.2, 0});
  loop.axis2 = Vector3::UnitX();
  loop.damping = 0.5;
  loop.friction = 0.05;
  b.scene.motions.push_back({"driven", TimeFunction::parse("0.05*sin(5*t)"), {}});
  b.scene.efforts.push_back({"elbow", TimeFunction::parse("t < 1 ? sin(10*t) : 0.5"), {}});
  b.scene.efforts.push_back({"continuous", TimeFunction::parse("0:0 1:0.2 2:0"), {}});
  b.load("beam4", tip, {1, 2, 0}, {0.1, 0, 0}, "cos(3*t)*exp(-t)");
  b.load("beam2", tip, {0, 1, 0}, {0, 0.1, 0}, "0:0 0.5:1", scene::LoadFrame::Follower);
  b.scene.distributed_loads.push_back(
      {"beam3", {0, 0, 1}, scene::LoadFrame::Follower, TimeFunction::parse("sin(t)"), {}});
  b.scene.initial_joints.push_back({"continuous", 0, 2, {}});
  b.probe("tip", "beam4", tip);
  b.probe("span", "beam3", {0.25, 0, 0});
  b.probe("body", "spherical_body", {0.1, 0, 0});
  return b;
}

/// The same scene with dry friction that sticks and grows with the force on the joint.
inline SceneBuilder rubbing_scene() {
  using scene::JointKind;
  SceneBuilder b = everything_scene();
  for (scene::JointDescription& joint : b.scene.joints) {
    joint.friction_law.law = scene::FrictionDescription::Law::Coulomb;
    if (joint.kind == JointKind::Spherical || joint.kind == JointKind::Floating || joint.kind == JointKind::Planar)
      continue;
    joint.friction_law.coefficient = 0.3;
    joint.friction_law.radius = 0.02;
  }
  return b;
}

/// The same scene with motors behind rigid and elastic gears, springs, and servos, one of which is sampled.
inline SceneBuilder driven_scene() {
  SceneBuilder b = everything_scene();
  const auto servo = [&](const std::string& joint, double kp, double kd, double ki) -> scene::ServoDescription& {
    scene::ServoDescription& out = b.servo(joint, kp, kd, ki);
    out.set_point = TimeFunction::parse("0.1*sin(3*t)");
    return out;
  };
  scene::DriveDescription& elastic = b.drive("elbow", 10, 1e-4);
  elastic.stiffness = 200;
  elastic.damping = 0.2;
  elastic.backlash = 1e-3;
  elastic.efficiency = 0.8;
  b.drive("continuous", 10, 1e-4).friction = 0.1;
  servo("elbow", 20, 1, 5).anti_windup = 0.1;
  servo("prismatic", 500, 10, 0);
  scene::ServoDescription& sampled = servo("continuous", 5, 0.2, 1);
  sampled.sample_time = 2 * b.scene.integrator.step;
  sampled.delay = 1.5 * sampled.sample_time;
  b.scene.springs.push_back({"hinge", 10, 0.01, {}});
  return b;
}

}  // namespace flexarm::test
