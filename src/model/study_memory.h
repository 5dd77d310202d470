#pragma once
/// What the schemes of the room study_schemes/ keep from step to step, as a part of the state. Other schemes neither
/// read nor write it.

#include <algorithm>
#include <vector>

#include "math/local_rotation.h"

namespace flexarm {

/// Material angular velocity [rad/s] and acceleration [rad/s^2] at a mass point, for schemes that integrate the rotary
/// inertia there.
struct MassPointState {
  Vector3 angular_velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero();
};

/// Rotation and curvature of a point of a beam, for schemes whose interpolation depends on the past.
using PointRotation = InterpolatedRotation<double>;

struct StudyMemory {
  std::vector<MassPointState> mass_points;  ///< always present, so that all schemes start from the same state
  std::vector<Vector6> strain_rates;        ///< per stiffness point [1/s, 1/(m s)]; always present; Newmark family
  // Empty unless the scheme needs them:
  std::vector<PointRotation> stiffness_rotations, mass_rotations;  ///< per point
  std::vector<Vector3> total_rotations;  ///< per node: rotation vector from the undeformed state, up to 2 pi
  std::vector<Vector6> forces;           ///< per node: internal minus external forces at the end of the last step
  std::vector<Vector6> reactions;        ///< per node: what joints transmitted to it in the last step
  std::vector<Vector3> momentum_rates;   ///< d(Lambda J W)/dt per mass point, then per node [N m]

  /// Memory of an equilibrium: nothing moves, and no step was before.
  void come_to_rest() {
    std::fill(mass_points.begin(), mass_points.end(), MassPointState());
    std::fill(strain_rates.begin(), strain_rates.end(), Vector6::Zero());
    std::fill(momentum_rates.begin(), momentum_rates.end(), Vector3::Zero());
    reactions.clear();
  }
};

}  // namespace flexarm
