#pragma once
/// All that time changes. A value: a copy is a checkpoint.

#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/joint.h"

namespace flexarm {

/// Motion of a node. Angular quantities are material (in the node's frame).
struct NodeState {
  Vector3 position = Vector3::Zero();  ///< [m]
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();              ///< [m/s]
  Vector3 angular_velocity = Vector3::Zero();      ///< W [rad/s]
  Vector3 acceleration = Vector3::Zero();          ///< [m/s^2], schemes of the Newmark family only
  Vector3 angular_acceleration = Vector3::Zero();  ///< A [rad/s^2], the same
};

/// Material angular velocity and acceleration at a mass point; schemes that integrate rotary inertia there.
struct MassPointState {
  Vector3 angular_velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero();
};

struct State {
  double time = 0;                 ///< [s]
  std::vector<NodeState> nodes;    ///< slaves included
  std::vector<Released> released;  ///< per elementary joint
  std::vector<MassPointState> mass_points;
  std::vector<Vector6> strain_rates;   ///< per stiffness point; Newmark family with damping only
  std::vector<double> commands;        ///< per coordinate: commanded effort, NaN where none holds
  std::vector<double> efforts;         ///< per coordinate: applied in the last step
  std::vector<double> last_increment;  ///< of the unknowns over the last sub-step: the predictor
  double last_step = 0;                ///< its length [s]; 0: none yet
  double work = 0, dissipated = 0;     ///< path integrals since the start [J]
  int halving_level = 0;               ///< sub-steps are step / 2^level
  int good_steps = 0;                  ///< converged sub-steps in a row at this level
  long steps = 0;                      ///< whole steps done
};

}  // namespace flexarm
