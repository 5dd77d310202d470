#pragma once
/// A load on a node: a force and a moment.

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"

namespace flexarm {

/// A force at the material point `arm` of the node's frame, and a moment, both scaled by history(t). Wrenches of a
/// state may also have a spring that pulls on that point.
struct NodalLoad {
  int node = -1;
  /// `arm` in the node's frame [m]; `force` [N] and `moment` [N m] in world axes or in the node's frame, see `follows`.
  Vector3 arm = Vector3::Zero(), force = Vector3::Zero(), moment = Vector3::Zero();
  bool follows = false;  ///< force and moment turn with the node; else their directions are fixed in the world
  int history = 0;       ///< index into Model::histories; not used in State::wrenches
  Pull pull = {};        ///< spring of the load; only in State::wrenches
  int link = -1;         ///< link on which it acts, index into Model::links
};

/// Returns a load on a link: a force at `point` (in the link's frame), and a moment. `link`: pose of the link's frame
/// in the node's frame. Force and moment are in world axes, or in the link's axes if the load follows the link.
inline NodalLoad load_on(int node, const Pose& link, const Vector3& point, const Vector3& force, const Vector3& moment,
                         bool follows) {
  const Quaternion turn = follows ? link.orientation : Quaternion::Identity();
  return {node, link * point, turn * force, turn * moment, follows, 0, {}, -1};
}

}  // namespace flexarm
