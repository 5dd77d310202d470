#pragma once
/// Combines rigid bodies (internal to building/).

#include "flexarm/scene/scene_description.h"
#include "math/so3.h"

namespace flexarm {

/// Several rigid bodies as one, in the frame of the node that carries them.
struct RigidBody {
  double mass = 0;
  Vector3 center = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre

  void operator+=(const RigidBody& other) {
    const double sum = mass + other.mass;
    const Vector3 joint_center = sum > 0 ? Vector3((mass * center + other.mass * other.center) / sum) : other.center;
    const auto shifted = [&](const RigidBody& body) {
      const Matrix3 d = so3::hat(Vector3(body.center - joint_center));
      return Matrix3(body.inertia - body.mass * d * d);
    };
    inertia = shifted(*this) + shifted(other);
    mass += other.mass;
    center = joint_center;
  }
};

/// The rigid body of a link. `link`: the link's frame relative to the node.
inline RigidBody body_of(const scene::RigidInertia& inertial, const Pose& link) {
  const Matrix3 rotation = link.orientation.toRotationMatrix();
  return {inertial.mass, link * inertial.center_of_mass, rotation * inertial.inertia * rotation.transpose()};
}

}  // namespace flexarm
