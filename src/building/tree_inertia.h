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
  /// Motion of the slave of a joint_of() per unit of each coordinate.
  const ReleasedColumns& columns_of(int joint) const { return columns_[joint]; }
  /// Calls visit(coordinate, motion) for all coordinates between a node and the root, from the node on. `motion`: of
  /// the node, per unit of the coordinate.
  template <class Visit>
  void for_each_way_to_move(int node, const Visit& visit) const;
  /// From the leaves to the root, calls release(node, inertia) for the inertia about the node of all that hangs on it,
  /// and adds to the parent what this leaves of it.
  template <class Release>
  void for_each_inertia(const Release& release) const;
  /// The inertia about a node of all that hangs on it, if no joint moves.
  const SpatialInertia& outboard(int node) const { return outboard_[node]; }
  /// The mass matrix of `size` unknowns, without rotors. An unknown may have several motions.
  Eigen::MatrixXd mass_matrix(const std::vector<TreeMotion>& motions, Eigen::Index size) const;

 private:
  SpatialInertia own(int node) const;
  Vector3 way(int from, int to) const { return model_.nodes[to].position - model_.nodes[from].position; }
  /// The motion of another node, as one rigid body.
  Vector6 seen_at(Vector6 motion, int from, int to) const;
  bool hangs_on(int node, int inboard) const;

  const std::vector<int>& parents_;
  const Model& model_;
  std::vector<int> joint_of_;             // per node
  std::vector<ReleasedColumns> columns_;  // per joint; empty if it moves no node against its parent
  std::vector<SpatialInertia> outboard_;  // per node
};

template <class Visit>
void TreeInertia::for_each_way_to_move(int node, const Visit& visit) const {
  for (int mover = node; mover >= 0; mover = parents_[mover]) {
    const int joint = joint_of_[mover];
    if (joint < 0) continue;
    for (Eigen::Index k = 0; k < columns_[joint].cols(); ++k)
      visit(model_.first_coordinate[joint] + static_cast<int>(k), seen_at(columns_[joint].col(k), mover, node));
  }
}

template <class Release>
void TreeInertia::for_each_inertia(const Release& release) const {
  std::vector<SpatialInertia> inertias;
  for (std::size_t i = 0; i < parents_.size(); ++i) inertias.push_back(own(static_cast<int>(i)));
  for (int i = static_cast<int>(parents_.size()); i-- > 0;) {  // parents come before their children
    release(i, inertias[i]);
    if (const int parent = parents_[i]; parent >= 0) inertias[parent] += moved(inertias[i], way(parent, i));
  }
}

}  // namespace flexarm
