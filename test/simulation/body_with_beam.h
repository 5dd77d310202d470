#pragma once
/// A mechanism for tests of wrenches and springs from outside.

#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {

/// A rigid body on a ball joint carries a beam with a node at its middle. The step is 2 ms.
inline SceneBuilder body_with_beam() {
  SceneBuilder b;
  b.scene.integrator.step = 0.002;
  b.body("body", 1, {0.3, 0, 0}, Vector3(0.1, 0.12, 0.15).asDiagonal());
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 200, 250, 300, 0.5, 0.02, 0.01, 0.01}, 4, 2);
  b.joint("ball", scene::JointKind::Spherical, "world", "body");
  b.joint("weld", scene::JointKind::Fixed, "body", "beam", {1, 0, 0});
  return b;
}

}  // namespace flexarm::test
