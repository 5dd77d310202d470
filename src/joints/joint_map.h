#pragma once
/// Elementary node-to-node joints (all but slides). The pose of the slave node is a function of the master's pose and
/// the released coordinates. Folding transforms the slave's residual and tangent into rows and columns of the master
/// and the released coordinates. (Muñoz 2004, ch. 7; joints.md 1) For the notation see model/joint.h.

#include "flexarm/math/pose.h"
#include "model/joint.h"

namespace flexarm {

/// Matrices with at most six columns or rows for the released coordinates of a joint. They need no heap.
using ReleasedColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// The maps that fold a slave's residual and tangent. With g = {f, phi} the slave's total residual,
///   released rows  += left^T g,                 master rows += {f, lever_left x f + phi}
///   slave columns d{r, spin} = right du + {dr_m + spin_m x lever_right, spin_m}
/// Further members are the derivatives of the left maps at constant g (geometric blocks). The master's position has no
/// effect on them, and its force row is constant. So there are only derivatives of the released rows and of the
/// master's moment, with respect to u and to the master's spin.
struct FoldMaps {
  ReleasedColumns left, right;
  Vector3 lever_left, lever_right;
  ReleasedSquare released_released;
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 6, 3> released_spin;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 6> moment_released;
  Matrix3 moment_spin;
};

/// Computes the slave's pose from the master's pose and the released coordinates (7.1).
NodePose slave_pose(const JointMap& joint, const NodePose& master, const Released& released);

/// Returns the released coordinates after the update `increment` of an iteration (Scalar: du; Spherical: spin in the
/// joint frame; Free: {translation, spin}).
Released updated(const JointMap& joint, const Released& released, const Eigen::Ref<const ReleasedVector>& increment);

/// Returns the increment of the released coordinates over a step, in the order of the unknowns (Scalar: Delta u;
/// rotations: tangent-scaled increment in the joint frame).
ReleasedVector released_increment(const JointMap& joint, const Released& from, const Released& to);

/// Computes the variational maps N_delta at one configuration, for the residual `g` on the slave (joints.md 1.2).
void variational_maps(const JointMap& joint, const JointPose& pose, const Vector6& g, FoldMaps& maps);

/// Computes the incremental maps N_Delta over a step (joints.md 1.3). The slave's {Delta r, tangent-scaled rotation
/// increment} equals exactly left Delta u + the master's part, so the joint does no work and conserves momenta. Without
/// `with_tangent` only the left maps are set. `arm_weight`: weight of the end of the step in the lever arm of the
/// slave's force on the master. It is 1/2 for schemes that measure angular momentum with mean arms, and 0 for those
/// that use the arms at the beginning (M2; its joints then do a little work).
void incremental_maps(const JointMap& joint, const JointPose& begin, const JointPose& end, const Vector6& g,
                      FoldMaps& maps, bool with_tangent = true, double arm_weight = 0.5);

/// Computes the released rates (a scalar, or translation and angular velocity in the joint frame) from the spatial
/// velocities {v, w} of master and slave, by least squares at the origin of the moved joint frame. `remainder`: output,
/// the part of the slave's velocity that the joint does not allow.
ReleasedVector released_rates(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                              const Vector6& slave_velocity, Vector6* remainder = nullptr);

/// Computes the slave's spatial velocity {v, w} from the master's and the released rates.
Vector6 slave_velocity(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                       const Eigen::Ref<const ReleasedVector>& rates);

}  // namespace flexarm
