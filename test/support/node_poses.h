#pragma once
/// Poses of nodes, for tests of elements that act between nodes.

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

/// `rotation`: a rotation vector.
inline NodePose turned_node(const Vector3& position, const Vector3& rotation) {
  return node_at(position, so3::exp_quaternion(rotation));
}

/// Returns a pose that is displaced and turned by {displacement, spatial rotation vector}.
inline NodePose moved(const NodePose& node, const Vector6& by) {
  return node_at(node.position + by.head<3>(), so3::exp_quaternion(Vector3(by.tail<3>())) * node.orientation);
}

/// Returns a state at rest with these poses.
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
