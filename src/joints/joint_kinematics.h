#pragma once
/// Kinematics of a model's joints of any kind.

#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/model.h"

namespace flexarm {

inline const NodePose kWorld;

/// Pose of a joint's master.
inline const NodePose& master_pose(const JointMap& joint, const std::vector<NodePose>& nodes) {
  return joint.master < 0 ? kWorld : nodes[joint.master];
}

/// Pose of its slave; the world's of a joint that is held on the world.
inline const NodePose& slave_node_pose(const JointMap& joint, const std::vector<NodePose>& nodes) {
  return joint.slave < 0 ? kWorld : nodes[joint.slave];
}

/// Of a joint that is no slide.
inline JointPose joint_pose(const JointMap& joint, const std::vector<NodePose>& nodes, const Released& released) {
  return {master_pose(joint, nodes), slave_node_pose(joint, nodes), released};
}

/// Pose of the slave of joint `j` from those of the other nodes.
NodePose slave_pose(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released);

/// How the velocity of a joint's slave follows.
struct SlaveVelocity {
  Vector6 carried;          ///< {v, w} with the released rates at zero
  ReleasedColumns columns;  ///< per released rate

  /// {v, w} with these released rates [m/s, rad/s].
  Vector6 with(const ReleasedVector& rates) const { return carried + columns * rates; }
};
/// `velocities`: spatial {v, w} of the model's nodes.
SlaveVelocity slave_velocity(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                             const std::vector<Vector6>& velocities);

/// Least-squares released rates from the velocities of all nodes.
ReleasedVector released_rates(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                              const std::vector<Vector6>& velocities);

}  // namespace flexarm
