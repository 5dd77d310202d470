#pragma once
/// A force and a moment on a node.

#include "flexarm/math/pose.h"

namespace flexarm {

/// A load on a node: force at the material point `arm` of its frame, and a moment; scaled by history(t).
struct NodalLoad {
  int node = -1;
  Vector3 arm = Vector3::Zero(), force = Vector3::Zero(), moment = Vector3::Zero();  ///< world or node frame
  bool follows = false;  ///< force and moment turn with the node; else they are fixed in the world
  int history = 0;       ///< index into Model::histories; a wrench of State::wrenches has none
};

}  // namespace flexarm
