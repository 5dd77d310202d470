#pragma once
/// Scenes with sliders.

#include "reference/dynamics_joint_chain.h"

namespace flexarm::test {

inline scene::JointDescription& add_slide(SceneBuilder& b, const std::string& name, const std::string& parent,
                                          const std::string& child, double start, scene::JointKind rotation) {
  scene::JointDescription& joint =
      b.joint(name, scene::JointKind::Slide, parent, child, Vector3::Zero(), Vector3(1, 2, 2) / 3);
  joint.axis2 = Vector3(0, 0.6, 0.8);
  joint.slide = scene::SlideDescription{start, rotation};
  return joint;
}

inline std::string first_coordinate(scene::JointKind rotation) {
  return rotation == scene::JointKind::Fixed ? "run" : "run/s";
}

/// Name of the independent coordinate: the angle of a joint with dependent travel, otherwise the arc length.
inline std::string free_coordinate(scene::JointKind rotation) {
  return scene::has_dependent_travel(rotation) ? "run/1" : first_coordinate(rotation);
}

/// A flexible arm with a body at its end slides on a free, spinning beam of eight elements.
inline SceneBuilder runner_on_a_free_beam(scene::JointKind rotation) {
  using scene::JointKind;
  SceneBuilder b;
  b.beam("line", {{4, 0.3, 0.2}}, soft_section(), 8, 2);
  b.beam("arm", {{0, 0.8, 0.3}}, soft_section(), 1, 2);
  b.body("hand", 0.8, {0.2, 0.1, -0.1}, 0.2 * body_inertia());
  b.joint("free", JointKind::Floating, "world", "line");
  scene::JointDescription& run = add_slide(b, "run", "line", "arm", 1.3, rotation);
  run.ratio = 0.4;
  run.offset = 0.1;
  if (rotation == JointKind::Cam)  // the profile moves it over three borders of elements and back
    run.profile = std::make_shared<CamProfile>(CamProfile::periodic({0, 1, 2.4, 4.1, 5}, {0, 0.6, 1.5, 1.2, 0.2}));
  if (rotation != JointKind::Spherical) run.slide->offset = {0.05, 0.1, -0.1};
  b.joint("wrist", JointKind::Fixed, "arm", "hand", {0, 0.8, 0.3});
  initial_field(b, "line", {0.1, -0.2, 0.1}, {0.3, 0.5, 1.0});
  const bool is_coupled = scene::has_dependent_travel(rotation);
  initial_joint(b, free_coordinate(rotation), is_coupled ? 0.2 : 1.3, is_coupled ? 3.5 : 1.5);
  return b;
}

/// Length of the line of the thesis's example 12.2 [m]. [Muñoz 2004]
const double kThesisLineLength = std::sqrt(10.0);

/// Thesis 12.2: a mass on a beam that slides on another beam, interpreted as in
/// config/thesis/12_2_free_sliding_mass.urdf.
inline Simulation thesis_free_sliding_mass(const std::string& scheme, double step,
                                           const scene::SlideDescription& slide) {
  using scene::JointKind;
  SceneBuilder b;
  const scene::DirectSection section{100, 100 / 2.6, 100 / 2.6, 20 / 1.3, 20, 20, 0.08, 0.032, 0.016, 0.016};
  b.beam("AB", {{0, 3, 1}}, section, 4, 2);
  b.beam("BM", {{1, 0, 0}}, section, 1, 2);
  b.body("M", 1, Vector3::Zero(), Matrix3::Zero());
  b.joint("free", JointKind::Floating, "world", "AB");
  scene::JointDescription& run = add_slide(b, "run", "AB", "BM", kThesisLineLength, JointKind::Spherical);
  run.slide->on_end = scene::SlideDescription::End::Error;
  run.slide->scheme = slide.scheme;
  run.slide->smooth = slide.smooth;
  b.joint("tip", JointKind::Fixed, "BM", "M", {1, 0, 0});
  b.scene.joints[1].origin.orientation = Quaternion::Identity();
  // The whole beam BM except its sliding end has the velocity.
  initial_field(b, "BM", {0, -10, -10}, Vector3::Zero());
  b.scene.initial_joints.push_back({"run/s", kThesisLineLength, 0, {}, true});
  return Simulation(b.scene, options(scheme, step, 1e-10));
}

}  // namespace flexarm::test
