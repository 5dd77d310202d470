#pragma once
/// Kinematics of a model's joints of any kind: poses and velocities of slaves, released rates.

#include "joints/joint_map.h"
#include "joints/slide_map.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

inline const NodePose kWorld;

/// Returns the pose of a joint's master.
inline const NodePose& master_pose(const JointMap& joint, const std::vector<NodePose>& nodes) {
  return joint.master < 0 ? kWorld : nodes[joint.master];
}

/// Returns the pose of a joint's slave. For a joint that is held on the world, returns the world's pose.
inline const NodePose& slave_node_pose(const JointMap& joint, const std::vector<NodePose>& nodes) {
  return joint.slave < 0 ? kWorld : nodes[joint.slave];
}

/// Returns the poses of a joint that is not a slide.
inline JointPose joint_pose(const JointMap& joint, const std::vector<NodePose>& nodes, const Released& released) {
  return {master_pose(joint, nodes), slave_node_pose(joint, nodes), released};
}

/// Computes the pose of the slave of joint `j` from the poses of the other nodes.
NodePose slave_pose(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released);

/// The velocity of a joint's slave as an affine function of the released rates.
struct SlaveVelocity {
  Vector6 carried;          ///< {v, w} if the released rates are zero
  ReleasedColumns columns;  ///< per released rate: {v, w} per unit rate

  /// Returns {v, w} with these released rates [m/s, rad/s].
  Vector6 with(const ReleasedVector& rates) const { return carried + columns * rates; }
};
/// `velocities`: spatial {v, w} of the model's nodes.
SlaveVelocity slave_velocity(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                             const std::vector<Vector6>& velocities);

/// Computes the released rates from the velocities of all nodes, by least squares.
ReleasedVector released_rates(const Model& model, int j, const std::vector<NodePose>& nodes, const Released& released,
                              const std::vector<Vector6>& velocities);

/// Rates of single coordinates in a state. Allocates no memory after construction.
class StateRates {
 public:
  explicit StateRates(const Model& model);

  /// The rate of coordinate `c` [m/s or rad/s]. `model`: the one of construction, or one that differs in numbers only.
  double operator()(const Model& model, const State& state, int c);

 private:
  std::vector<NodePose> poses_;      // of all nodes, for sliders only
  std::vector<Vector6> velocities_;  // the same
};

}  // namespace flexarm
