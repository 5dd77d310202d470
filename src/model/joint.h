#pragma once
/// Constant data of elementary joints, the values of their released coordinates, and poses of nodes.
///
/// A joint computes the pose of its slave node (r, Lambda) from that of its master node (r_m, Lambda_m):
///   r = r_m + Lambda_m b + B (displacement) + Lambda a,   Lambda = B Lambda_J Lambda_0.
/// B = Lambda_m A is the orientation of the joint frame, A its orientation in the master node's frame, b its origin
/// there. The moved joint frame is the joint frame after the released motion; a is the arm from its origin to the slave
/// node. Joints with one coordinate have A = I: their axes are given in the master node's frame. A joint with several
/// scalar coordinates is a chain of elementary joints through massless nodes.

#include <cstddef>
#include <memory>
#include <vector>

#include "flexarm/math/cam_profile.h"
#include "flexarm/math/pose.h"
#include "model/slide_line.h"

namespace flexarm {

/// Kinds of elementary joints, by their released coordinates.
enum class JointMapKind {
  Rigid,      ///< none
  Scalar,     ///< one: translation along `translation` and rotation about `rotation`, both functions of it
  Spherical,  ///< three: a free rotation
  Free,       ///< six: translation and rotation
  Slide       ///< one: the arc length of a section that slides along a line of nodes
};

constexpr int released_count(JointMapKind kind) {
  switch (kind) {
    case JointMapKind::Rigid:
      return 0;
    case JointMapKind::Scalar:
    case JointMapKind::Slide:
      return 1;
    case JointMapKind::Spherical:
      return 3;
    case JointMapKind::Free:
      return 6;
  }
  return 0;
}

/// Constant data of an elementary joint.
struct JointMap {
  JointMapKind kind = JointMapKind::Rigid;
  int master = -1;                                        ///< node; -1: the world; Slide: first node of the line
  int slave = -1;                                         ///< node
  Pose origin;                                            ///< joint frame in the master node's frame (b, A)
  Quaternion slave_orientation = Quaternion::Identity();  ///< Lambda_0: slave node's frame in the moved joint frame
  Vector3 arm = Vector3::Zero();                          ///< a, in the slave node's frame [m]
  int line = -1;                                          ///< Slide: index into Model::slide_lines
  SlideAlgorithm algorithm;                               ///< Slide
  int leaving = -1;  ///< Slide: joint whose slave becomes free beyond the ends of the line; -1: none
  Vector3 translation = Vector3::Zero();      ///< Scalar: travel per unit of f(coordinate)
  std::shared_ptr<const CamProfile> profile;  ///< Scalar: f; null: f(u) = u
  Vector3 rotation = Vector3::Zero();         ///< Scalar: rotation vector per unit coordinate
};

/// Moves the description of a joint into the master node's frame. `frame`: pose, in the master node's frame, of the
/// frame in which the joint was described.
inline void place(JointMap& joint, const Pose& frame) {
  joint.origin = frame * joint.origin;
  if (joint.kind != JointMapKind::Scalar) return;
  const Quaternion turn = joint.origin.orientation;
  joint.origin.orientation.setIdentity();
  joint.translation = turn * joint.translation;
  joint.rotation = turn * joint.rotation;
  joint.slave_orientation = turn * joint.slave_orientation;
}

/// Elementary joints, from the root to the leaves. Joints that a constant motion holds come after all others. Iteration
/// over the list skips these; they are accessible only by index (Coordinate::joint).
class JointList {
 public:
  std::size_t size() const { return maps_.size() - held_; }  ///< without held joints
  std::size_t size_with_held() const { return maps_.size(); }
  bool is_held(int joint) const { return joint >= static_cast<int>(size()); }
  auto begin() { return maps_.begin(); }
  auto begin() const { return maps_.begin(); }
  auto end() { return maps_.end() - static_cast<std::ptrdiff_t>(held_); }
  auto end() const { return maps_.end() - static_cast<std::ptrdiff_t>(held_); }
  JointMap& operator[](std::size_t joint) { return maps_[joint]; }
  const JointMap& operator[](std::size_t joint) const { return maps_[joint]; }
  const JointMap& front() const { return maps_.front(); }
  /// Adds a joint after the last one that is not held. The indices of held joints grow by one.
  void push_back(const JointMap& map) { maps_.insert(end(), map); }
  void push_back_held(const JointMap& map) {
    maps_.push_back(map);
    ++held_;
  }

 private:
  std::vector<JointMap> maps_;
  std::size_t held_ = 0;
};

/// Values of the released coordinates of a joint.
struct Released {
  Vector3 displacement = Vector3::Zero();        ///< Scalar, Slide: u in [0]; Free: translation in the joint frame [m]
  Quaternion rotation = Quaternion::Identity();  ///< Spherical, Free: Lambda_J
};

/// A node's pose; `rotation` is the matrix of `orientation`.
struct NodePose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  Matrix3 rotation = Matrix3::Identity();
};

/// The poses of a joint's nodes and its released coordinates at an instant.
struct JointPose {
  const NodePose &master, &slave;
  const Released& released;
};

/// Returns the origin of the moved joint frame, computed from the pose of the slave.
inline Vector3 moved_origin(const JointMap& joint, const NodePose& slave) {
  return slave.position - slave.rotation * joint.arm;
}

}  // namespace flexarm
