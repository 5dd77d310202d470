#pragma once
/// Constant data of elementary joints, the values of their released coordinates, and poses of nodes.
///
/// Notation: B = Lambda_m A the joint frame, A its orientation in the master node's frame, b its origin there:
///   r = r_m + Lambda_m b + B (displacement),   Lambda = B Lambda_J Lambda_0.
/// A joint with several scalar coordinates is a chain of elementary ones through massless nodes.

#include "flexarm/math/pose.h"

namespace flexarm {

/// Which released coordinates an elementary joint has.
enum class JointMapKind {
  Rigid,      ///< none
  Scalar,     ///< one: translation along `translation` and rotation about `rotation`, both proportional to it
  Spherical,  ///< three: a free rotation
  Free        ///< six: translation and rotation
};

constexpr int released_count(JointMapKind kind) {
  return kind == JointMapKind::Rigid ? 0 : kind == JointMapKind::Scalar ? 1 : kind == JointMapKind::Spherical ? 3 : 6;
}

/// Constant data of an elementary joint.
struct JointMap {
  JointMapKind kind = JointMapKind::Rigid;
  int master = -1;                                        ///< node; -1: the world
  int slave = -1;                                         ///< node
  Pose origin;                                            ///< joint frame in the master node's frame (b, A)
  Quaternion slave_orientation = Quaternion::Identity();  ///< Lambda_0: slave node's frame in the moved joint frame
  Vector3 translation = Vector3::Zero();                  ///< Scalar: travel per unit coordinate, joint frame
  Vector3 rotation = Vector3::Zero();                     ///< Scalar: rotation vector per unit coordinate, joint frame
};

/// Values of the released coordinates.
struct Released {
  Vector3 displacement = Vector3::Zero();        ///< Scalar: u in [0]; Free: translation in the joint frame [m]
  Quaternion rotation = Quaternion::Identity();  ///< Spherical, Free: Lambda_J
};

/// A node's pose with its rotation matrix at hand.
struct NodePose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  Matrix3 rotation = Matrix3::Identity();
};

}  // namespace flexarm
