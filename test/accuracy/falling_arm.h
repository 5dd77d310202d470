#pragma once
/// Falling arms, for tests of errors.

#include "support/scene_builder.h"

namespace flexarm::test {

/// Two beams of two elements on hinges, which fall from the horizontal, not in one plane.
inline SceneBuilder falling_arm() {
  SceneBuilder b;
  const scene::DirectSection soft = section(4e3, 2e3, 40, 60, 1, 0.01, 0.005);
  b.beam("upper", {{1, 0, 0}}, soft, 2, 2);
  b.beam("fore", {{0, 0.8, 0}}, soft, 2, 2);
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.joint("elbow", scene::JointKind::Revolute, "upper", "fore", {1, 0, 0}, Vector3::UnitX());
  b.probe("tip", "fore", {0, 0.8, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = 1e-10;
  return b;
}

/// Two rigid links. They have no fast modes, so that orders are visible with any step.
inline SceneBuilder falling_links() {
  SceneBuilder b;
  Matrix3 inertia = Vector3(0.02, 0.03, 0.04).asDiagonal();
  b.body("upper", 1, {0.5, 0, 0}, inertia);
  b.body("fore", 0.7, {0, 0.4, 0}, inertia);
  b.joint("shoulder", scene::JointKind::Revolute, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.joint("elbow", scene::JointKind::Revolute, "upper", "fore", {1, 0, 0}, Vector3::UnitX());
  b.probe("tip", "fore", {0, 0.8, 0});
  b.scene.gravity = {0, 0, -9.81};
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

}  // namespace flexarm::test
