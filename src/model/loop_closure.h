#pragma once
/// Closures of kinematic loops: constraints between two nodes, enforced by Lagrange multipliers. (joints.md 3)

#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// One scalar constraint. It is quadratic in positions and rotation matrices, so its gradient at the mean of a step's
/// ends gives its exact change over the step. r, Lambda: poses of the closure's nodes; index a: parent, b: child.
///   Gap:       (r_b + Lambda_b arm_b - r_a - Lambda_a arm_a) . Lambda_a normal = 0   [m]
///   Direction: Lambda_b direction . Lambda_a normal = value                           [-]
struct ClosureConstraint {
  enum class Kind { Gap, Direction };
  Kind kind = Kind::Gap;
  Vector3 normal = Vector3::Zero();     ///< unit vector in the parent node's frame
  Vector3 direction = Vector3::Zero();  ///< Direction: unit vector in the child node's frame
  double value = 0;                     ///< Direction: the product's value in the initial configuration
};

/// A joint that closes a loop and has no coordinates of its own. At most six constraints.
struct LoopClosure {
  std::string name;             ///< of the joint
  int parent = -1, child = -1;  ///< nodes; -1: the world
  bool is_reversed = false;     ///< `child` is on the joint's parent link, since the joint's child link is the world
  Vector3 parent_arm = Vector3::Zero(),
          child_arm = Vector3::Zero();         ///< from the nodes to the joint's origin, in their frames [m]
  std::vector<ClosureConstraint> constraints;  ///< independent in the initial configuration; each has a multiplier
  std::vector<ClosureConstraint> implied;      ///< follow from the `constraints` of all closures; no multipliers
};

}  // namespace flexarm
