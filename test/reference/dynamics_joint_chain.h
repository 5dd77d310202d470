#pragma once
/// Free beams and trees of links with every kind of joint, for tests of invariants and of Newton's method.

#include "reference/dynamics_runs.h"
#include "scene/joint_kinds.h"

namespace flexarm::test {

/// A slender flexible section, which bends visibly at spins of about 1 rad/s.
inline scene::DirectSection soft_section() {
  return {2e3, 1e3, 1e3, 80, 100, 120, 1, 0.2, 0.1, 0.1};
}

inline Matrix3 body_inertia() {
  Matrix3 inertia;
  inertia << 0.5, 0.05, 0.02, 0.05, 0.6, -0.03, 0.02, -0.03, 0.7;
  return inertia;
}

/// The kinds of joints that a scene names, without <couple> or <slide>.
inline std::vector<scene::JointKindTraits> named_joint_kinds() {
  std::vector<scene::JointKindTraits> out;
  for (const scene::JointKindTraits& traits : scene::joint_kinds())
    if (traits.type || traits.release) out.push_back(traits);
  return out;
}

/// A floating beam "trunk" with a beam "branch" on a joint of the given kind at its tip. The branch carries a rigid
/// body with an offset centre of mass. A second rigid body is on the same kind of joint at mid-span.
inline SceneBuilder free_tree(scene::JointKind kind) {
  SceneBuilder b;
  b.beam("trunk", {{2, 0, 0}, {3, 1, 0.5}}, soft_section(), 1, 2);
  b.beam("branch", {{0.5, 2, 0.3}}, soft_section(), 2, 2);
  b.body("hand", 0.8, {0.2, 0.1, -0.1}, body_inertia());
  b.body("rider", 1.1, {-0.1, 0.3, 0.2}, body_inertia());
  b.joint("free", scene::JointKind::Floating, "world", "trunk");
  scene::JointDescription& shoulder = b.joint("shoulder", kind, "trunk", "branch", {3, 1, 0.5}, Vector3(1, 2, 2) / 3);
  shoulder.axis2 = Vector3(0, 0.6, 0.8);
  b.joint("wrist", scene::JointKind::Fixed, "branch", "hand", {0.5, 2, 0.3});
  scene::JointDescription& mount = b.joint("mount", kind, "trunk", "rider", {1, 0, 0.2}, Vector3(2, -1, 2) / 3);
  mount.axis2 = Vector3(0.8, 0.6, 0);
  initial_field(b, "trunk", {0.4, -0.2, 0.1}, {0.3, 0.5, 1.0});
  return b;
}

/// A floating tree of four beams with revolute, prismatic and spherical joints. Stops hold the slider, which the spin
/// would throw out otherwise. Their dissipation is part of the balance.
inline SceneBuilder free_beam_tree() {
  using scene::JointKind;
  SceneBuilder b;
  b.beam("trunk", {{3, 0, 0}}, soft_section(), 2, 2);
  b.beam("left", {{0, 2, 0}}, soft_section(), 1, 2);
  b.beam("right", {{1, -1, 1}}, soft_section(), 1, 3);
  b.beam("slider", {{0, 0, 1}}, soft_section(), 1, 1);
  b.joint("free", JointKind::Floating, "world", "trunk");
  b.joint("hinge", JointKind::Revolute, "trunk", "left", {3, 0, 0}, {0, 0, 1});
  b.joint("ball", JointKind::Spherical, "trunk", "right", {1.5, 0, 0.1});
  b.joint("rail", JointKind::Prismatic, "left", "slider", {0, 2, 0}, {0, 1, 0}).limits = scene::JointLimits{-0.5, 0.5};
  initial_field(b, "trunk", {0.1, 0, -0.1}, {0.2, 0.1, 0.4});
  initial_joint(b, "hinge", 0.2, -0.5);
  initial_joint(b, "rail", 0.1, 0.02);
  set_drift(b, {0.002, -0.001, 0.003});
  return b;
}

/// A flexible arm with a revolute shoulder, a spherical elbow, and a gripper with offset mass fixed to its end, under
/// weak gravity.
inline SceneBuilder flexible_arm(const scene::DirectSection& section, int fore_elements) {
  using scene::JointKind;
  SceneBuilder b;
  b.beam("upper", {{1, 0, 0}, {1.5, 0.3, 0}}, section, 1, 2);
  b.beam("fore", {{0, 1, 0.2}}, section, fore_elements, 2);
  b.body("gripper", 0.8, {0.1, 0.05, -0.1}, 0.2 * body_inertia());
  b.joint("shoulder", JointKind::Revolute, "world", "upper", {0, 0, 0}, Vector3(1, 2, 2) / 3);
  b.joint("elbow", JointKind::Spherical, "upper", "fore", {1.5, 0.3, 0});
  b.joint("wrist", JointKind::Fixed, "fore", "gripper", {0, 1, 0.2});
  b.scene.gravity = {0, 0, -2};
  return b;
}

/// A bent flexible beam that tumbles about an axis that is no principal axis, so that it bends and twists.
inline SceneBuilder tumbling_beam() {
  SceneBuilder b;
  b.beam("beam", {{3, 0, 0}, {5, 2, 1}}, soft_section(), 2, 2);
  b.joint("free", scene::JointKind::Floating, "world", "beam");
  initial_field(b, "beam", Vector3::Zero(), {0.8, 1.5, -1.1});
  set_drift(b, {0.003, -0.001, 0.002});
  return b;
}

}  // namespace flexarm::test
