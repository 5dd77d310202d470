#pragma once
/// A free-flying ring of rigid bodies, for tests of loops.

#include "support/loops.h"

namespace flexarm::test {

/// Returns a floating trunk with two arms of two bodies in spherical and revolute joints, and a joint between the ends
/// of the arms.
inline SceneBuilder free_ring(scene::JointKind kind) {
  SceneBuilder b;
  b.body("trunk", 1, {0.1, 0, 0.05}, Vector3(0.05, 0.06, 0.07).asDiagonal());
  b.joint("flight", scene::JointKind::Floating, "world", "trunk");
  const auto arm = [&](const std::string& name, double side) {
    b.body(name, 0.4, {0.2, 0.05 * side, 0.02}, Vector3(0.01, 0.02, 0.015).asDiagonal());
    b.body(name + "_end", 0.3, {0.1, -0.1 * side, 0}, Vector3(0.01, 0.008, 0.012).asDiagonal());
    b.joint(name, scene::JointKind::Spherical, "trunk", name, {0, 0.2 * side, 0});
    b.joint(name + "_end", scene::JointKind::Spherical, name, name + "_end", {0.4, 0.2 * side, 0.1});
  };
  arm("left", 1);
  arm("right", -1);
  scene::JointDescription& loop =
      close_loop(b, "loop", kind, "left_end", "right_end", {0.2, 0.3, 0.05}, {0.48, 0.6, 0.64});
  loop.axis2 = Vector3::UnitX();
  b.scene.initial_joints = {{"left/rz", 0, 1.5, {}}, {"flight/rx", 0, 1, {}}, {"flight/ry", 0, -2, {}}};
  return b;
}

}  // namespace flexarm::test
