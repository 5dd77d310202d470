#pragma once
/// Loops of rigid links: constraints between two nodes, held by Lagrange multipliers. (joints.md 3)

#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// One constraint, quadratic in positions and rotation matrices, so that the middle of a step gives its exact
/// difference; r, Lambda of the closure's nodes, a of the parent, b of the child:
///   Gap:       (r_b + Lambda_b arm_b - r_a - Lambda_a arm_a) . Lambda_a normal = 0   [m]
///   Direction: Lambda_b direction . Lambda_a normal = value                           [-]
struct ClosureConstraint {
  enum class Kind { Gap, Direction };
  Kind kind = Kind::Gap;
  Vector3 normal = Vector3::Zero();     ///< unit vector in the parent node's frame
  Vector3 direction = Vector3::Zero();  ///< Direction: unit vector in the child node's frame
  double value = 0;                     ///< Direction: at the start
};

/// A joint that closes a loop and has no coordinates of its own. At most six constraints.
struct LoopClosure {
  std::string name;             ///< of the joint
  int parent = -1, child = -1;  ///< nodes; -1: the world
  bool is_reversed = false;     ///< the child is on the joint's parent: that of the joint stands on the world
  Vector3 parent_arm = Vector3::Zero(),
          child_arm = Vector3::Zero();         ///< of the joint's origin, in the nodes' frames [m]
  std::vector<ClosureConstraint> constraints;  ///< independent ones at the start: each has a multiplier
  std::vector<ClosureConstraint> implied;      ///< hold by themselves where the others of all closures do
};

}  // namespace flexarm
