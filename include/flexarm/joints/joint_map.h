#pragma once
/// Elementary node-to-node joints: the slave's pose as a function of its master's pose and the released coordinates,
/// and the maps that fold the slave's residual and tangent into them. (Muñoz 2004, ch. 7; joints.md 1)
///
/// Notation: B = Lambda_m A the joint frame, A its orientation in the master node's frame, b its origin there:
///   r = r_m + Lambda_m b + B (displacement),   Lambda = B Lambda_J Lambda_0.
/// A joint with several scalar coordinates is a chain of elementary ones through massless nodes.

#include "flexarm/math/pose.h"

namespace flexarm {

/// Which released coordinates an elementary joint has.
enum class JointMapKind {
  Rigid,      ///< none
  Scalar,     ///< one: translation along `translation` and rotation about `rotation`, both proportional to it
  Spherical,  ///< three: a free rotation
  Free        ///< six: translation and rotation
};

constexpr int released_count(JointMapKind kind) {
  return kind == JointMapKind::Rigid ? 0 : kind == JointMapKind::Scalar ? 1 : kind == JointMapKind::Spherical ? 3 : 6;
}

/// Constant data of an elementary joint.
struct JointMap {
  JointMapKind kind = JointMapKind::Rigid;
  int master = -1;                                        ///< node; -1: the world
  int slave = -1;                                         ///< node
  Pose origin;                                            ///< joint frame in the master node's frame (b, A)
  Quaternion slave_orientation = Quaternion::Identity();  ///< Lambda_0: slave node's frame in the moved joint frame
  Vector3 translation = Vector3::Zero();                  ///< Scalar: travel per unit coordinate, joint frame
  Vector3 rotation = Vector3::Zero();                     ///< Scalar: rotation vector per unit coordinate, joint frame
};

/// Values of the released coordinates.
struct Released {
  Vector3 displacement = Vector3::Zero();        ///< Scalar: u in [0]; Free: translation in the joint frame [m]
  Quaternion rotation = Quaternion::Identity();  ///< Spherical, Free: Lambda_J
};

/// A node's pose with its rotation matrix at hand.
struct NodePose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  Matrix3 rotation = Matrix3::Identity();
};

/// Columns for the released coordinates of a joint, at most six; no heap.
using ReleasedColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
using ReleasedSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using ReleasedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// How a slave folds: with g the slave's total residual {f, phi},
///   released rows  += left^T g,                 master rows += {f, lever_left x f + phi}
///   slave columns d{r, spin} = right du + {dr_m + spin_m x lever_right, spin_m}
/// and the derivative of the left map at constant g (geometric blocks; u released, m master {r, spin}).
struct FoldMaps {
  ReleasedColumns left, right;
  Vector3 lever_left, lever_right;
  ReleasedSquare released_released;
  ReleasedRows released_master;
  ReleasedColumns master_released;
  Matrix6 master_master;
};

/// Slave pose from the master's and the released coordinates (7.1).
NodePose slave_pose(const JointMap& joint, const NodePose& master, const Released& released);

/// New released coordinates after the Newton update `increment` (Scalar: du; Spherical: spin in the joint frame;
/// Free: {translation, spin}).
Released updated(const JointMap& joint, const Released& released, const Eigen::Ref<const ReleasedVector>& increment);

/// Released increment over a step, in the order of the unknowns: Scalar: Delta u; rotations: tangent-scaled increment
/// in the joint frame.
ReleasedVector released_increment(const JointMap& joint, const Released& from, const Released& to);

/// Variational maps N_delta at the configuration (master, released), for residual `g` on the slave (joints.md 1.2).
void variational_maps(const JointMap& joint, const NodePose& master, const Released& released, const Vector6& g,
                      FoldMaps& maps);

/// Incremental maps N_Delta over a step from `_begin` to `_end` (joints.md 1.3): the slave's {Delta r, tangent-scaled
/// rotation increment} equals left du + {..} exactly, so the joint does no work and conserves momenta.
/// Without `with_tangent` only the left maps are set.
void incremental_maps(const JointMap& joint, const NodePose& master_begin, const NodePose& master_end,
                      const Released& begin, const Released& end, const Vector6& g, FoldMaps& maps,
                      bool with_tangent = true);

/// Least-squares released rates {scalar, or translation and angular velocity in the joint frame} from spatial
/// velocities {v, w} of master and slave; `remainder` gets the part of the slave's velocity that the joint does not
/// allow.
ReleasedVector released_rates(const JointMap& joint, const NodePose& master, const Released& released,
                              const Vector6& master_velocity, const Vector6& slave_velocity,
                              Vector6* remainder = nullptr);

/// Spatial velocity {v, w} of the slave from the master's and the released rates.
Vector6 slave_velocity(const JointMap& joint, const NodePose& master, const Released& released,
                       const Vector6& master_velocity, const Eigen::Ref<const ReleasedVector>& rates);

}  // namespace flexarm
