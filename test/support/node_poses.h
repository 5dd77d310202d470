#pragma once
/// Poses of nodes, for tests of what acts between them.

#include <vector>

#include "math/so3.h"
#include "model/joint.h"
#include "model/state.h"

namespace flexarm::test {

inline NodePose node_at(const Vector3& position, const Quaternion& orientation) {
  return {position, orientation, orientation.toRotationMatrix()};
}
inline NodePose node_at(const Pose& pose) {
  return node_at(pose.position, pose.orientation);
}

/// Displaced and turned by {displacement, spatial rotation vector}.
inline NodePose moved(const NodePose& node, const Vector6& by) {
  return node_at(node.position + by.head<3>(), so3::exp_quaternion(Vector3(by.tail<3>())) * node.orientation);
}

/// At rest.
inline State state_at(const std::vector<NodePose>& poses) {
  State state;
  for (const NodePose& pose : poses) {
    state.nodes.emplace_back();
    state.nodes.back().position = pose.position;
    state.nodes.back().orientation = pose.orientation;
  }
  return state;
}

}  // namespace flexarm::test
