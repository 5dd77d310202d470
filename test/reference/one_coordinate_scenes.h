#pragma once
/// Scenes of one body with one coordinate, without gravity.

#include <string>

#include "reference/dynamics_runs.h"

namespace flexarm::test {

/// Mass of the block [kg], and moment of inertia about the shaft of the wheel [kg m^2].
constexpr double kBlockMass = 2.0, kWheelInertia = 0.4;

/// A block on the joint "rail" along x.
inline SceneBuilder block_on_rail(double position = 0, double velocity = 0) {
  SceneBuilder b;
  b.body("block", kBlockMass, {0.1, 0.2, 0}, Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block", {0, 0, 0}, {1, 0, 0});
  initial_joint(b, "rail", position, velocity);
  return b;
}

/// A wheel on the joint "shaft" along z.
inline SceneBuilder wheel_on_shaft(double velocity = 0) {
  SceneBuilder b;
  b.body("wheel", 1, {0, 0, 0.3}, Vector3(1, 1, kWheelInertia).asDiagonal());
  b.joint("shaft", scene::JointKind::Revolute, "world", "wheel", {0, 0, 0}, {0, 0, 1});
  initial_joint(b, "shaft", 0, velocity);
  return b;
}

}  // namespace flexarm::test
