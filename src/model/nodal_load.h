#pragma once
/// A force and a moment on a node.

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"

namespace flexarm {

/// A load on a node: force at the material point `arm` of its frame, and a moment; scaled by history(t). Wrenches may
/// pull on that point besides.
struct NodalLoad {
  int node = -1;
  Vector3 arm = Vector3::Zero(), force = Vector3::Zero(), moment = Vector3::Zero();  ///< world or node frame
  bool follows = false;  ///< force and moment turn with the node; else they are fixed in the world
  int history = 0;       ///< index into Model::histories; a wrench of State::wrenches has none
  Pull pull = {};        ///< only of State::wrenches
  int link = -1;         ///< on which it acts; index into Model::links
};

/// A force, and a moment about `point` of a link whose frame seen from the node is `link`. Their axes are the world's,
/// or those of the link where the load follows it.
inline NodalLoad load_on(int node, const Pose& link, const Vector3& point, const Vector3& force, const Vector3& moment,
                         bool follows) {
  const Quaternion turn = follows ? link.orientation : Quaternion::Identity();
  return {node, link * point, turn * force, turn * moment, follows, 0, {}, -1};
}

}  // namespace flexarm
