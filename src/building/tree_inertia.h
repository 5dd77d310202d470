#pragma once
/// Inertia of a tree of links at the start, for {displacement, spin} in world axes (internal to building/). Beams count
/// as rigid, and sliders as locked.

#include <vector>

#include "joints/kinematics.h"

namespace flexarm {

/// Inertia about a node.
using SpatialInertia = Matrix6;

/// The inertia about another point. `way`: from that point to the present one.
SpatialInertia moved(const SpatialInertia& inertia, const Vector3& way);

/// The motion {displacement, spin} of a node, and of all that hangs on it, per unit of an unknown.
struct TreeMotion {
  int unknown, node;
  Vector6 motion;
};

class TreeInertia {
 public:
  /// `parents`: see Mechanism.
  TreeInertia(const std::vector<int>& parents, const Model& model);

  /// The joint that moves a node against its parent. -1 if there is none; then the node hangs on the parent like a
  /// rigid body.
  int joint_of(int node) const { return joint_of_[node]; }
  /// Motion of a joint's slave per unit of each coordinate.
  ReleasedColumns columns_of(int joint) const;
  /// The motion of another node, as one rigid body.
  Vector6 seen_at(Vector6 motion, int from, int to) const;
  /// Inertia of a node alone, and with all that hangs on it if no joint moves; about the node.
  SpatialInertia own(int node) const;
  const SpatialInertia& outboard(int node) const { return outboard_[node]; }
  /// The mass matrix of `size` unknowns, without rotors. An unknown may have several motions.
  Eigen::MatrixXd mass_matrix(const std::vector<TreeMotion>& motions, Eigen::Index size) const;

 private:
  bool hangs_on(int node, int inboard) const;

  const std::vector<int>& parents_;
  const Model& model_;
  std::vector<int> joint_of_;
  std::vector<SpatialInertia> outboard_;
};

}  // namespace flexarm
