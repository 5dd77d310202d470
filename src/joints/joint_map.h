#pragma once
/// Elementary node-to-node joints: the slave's pose as a function of its master's pose and the released coordinates,
/// and the maps that fold the slave's residual and tangent into them. (Muñoz 2004, ch. 7; joints.md 1)
/// The notation is that of JointMap.

#include "flexarm/math/pose.h"
#include "model/joint.h"

namespace flexarm {

/// Columns for the released coordinates of a joint, at most six; no heap.
using ReleasedColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// How a slave folds: with g the slave's total residual {f, phi},
///   released rows  += left^T g,                 master rows += {f, lever_left x f + phi}
///   slave columns d{r, spin} = right du + {dr_m + spin_m x lever_right, spin_m}
/// and the derivative of the left map at constant g (geometric blocks). Where the master is does not count, and its
/// force does not vary: what remains is that of the released rows and of the master's moment, with respect to u and to
/// the master's spin.
struct FoldMaps {
  ReleasedColumns left, right;
  Vector3 lever_left, lever_right;
  ReleasedSquare released_released;
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 6, 3> released_spin;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 6> moment_released;
  Matrix3 moment_spin;
};

/// Slave pose from the master's and the released coordinates (7.1).
NodePose slave_pose(const JointMap& joint, const NodePose& master, const Released& released);

/// New released coordinates after the Newton update `increment` (Scalar: du; Spherical: spin in the joint frame;
/// Free: {translation, spin}).
Released updated(const JointMap& joint, const Released& released, const Eigen::Ref<const ReleasedVector>& increment);

/// Released increment over a step, in the order of the unknowns: Scalar: Delta u; rotations: tangent-scaled increment
/// in the joint frame.
ReleasedVector released_increment(const JointMap& joint, const Released& from, const Released& to);

/// Variational maps N_delta for residual `g` on the slave (joints.md 1.2).
void variational_maps(const JointMap& joint, const JointPose& pose, const Vector6& g, FoldMaps& maps);

/// Incremental maps N_Delta over a step (joints.md 1.3): the slave's {Delta r, tangent-scaled rotation increment}
/// equals left du + {..} exactly, so the joint does no work and conserves momenta. Without `with_tangent` only the left
/// maps are set. `arm_weight`: of the end in the lever arm by which the slave's force turns the master; 1/2 where
/// momenta are measured with mean arms, 0 with those of the beginning (M2, its joints then do a little work).
void incremental_maps(const JointMap& joint, const JointPose& begin, const JointPose& end, const Vector6& g,
                      FoldMaps& maps, bool with_tangent = true, double arm_weight = 0.5);

/// Released rates {scalar, or translation and angular velocity in the joint frame} from spatial velocities {v, w} of
/// master and slave: least squares at the origin of the moved joint frame. `remainder` gets the part of the slave's
/// velocity that the joint does not allow.
ReleasedVector released_rates(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                              const Vector6& slave_velocity, Vector6* remainder = nullptr);

/// Spatial velocity {v, w} of the slave from the master's and the released rates.
Vector6 slave_velocity(const JointMap& joint, const JointPose& pose, const Vector6& master_velocity,
                       const Eigen::Ref<const ReleasedVector>& rates);

}  // namespace flexarm
