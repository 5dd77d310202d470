#pragma once
/// Everything that changes with time. A value: a copy is a checkpoint.

#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"
#include "math/local_rotation.h"
#include "model/actuator.h"
#include "model/increment_history.h"
#include "model/joint.h"
#include "model/nodal_load.h"
#include "model/step_means.h"

namespace flexarm {

/// Motion of a node. Angular quantities are material (in the node's frame).
struct NodeState {
  Vector3 position = Vector3::Zero();  ///< [m]
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();          ///< [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< W [rad/s]
  Vector3 mean_spin =
      Vector3::Zero();  ///< of the last step, tangent-scaled, in the world [rad/s]; energy-momentum family
  Vector3 acceleration = Vector3::Zero();          ///< [m/s^2], schemes of the Newmark family only
  Vector3 angular_acceleration = Vector3::Zero();  ///< A [rad/s^2], the same
};

inline NodePose node_pose(const NodeState& node) {
  return {node.position, node.orientation, node.orientation.toRotationMatrix()};
}

/// {v, w}, world axes.
inline Vector6 spatial_velocity(const NodeState& node) {
  Vector6 velocity;
  velocity << node.velocity, node.orientation * node.angular_velocity;
  return velocity;
}

/// Material angular velocity and acceleration at a mass point; schemes that integrate rotary inertia there.
struct MassPointState {
  Vector3 angular_velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero();
};

/// What numerical dissipation and structural damping remember at a stiffness point (NumericalDamper, StructuralDamper).
template <typename S>
struct StrainMemoryT {
  Vector6T<S> average = Vector6T<S>::Zero();       ///< of past strain increments [-, 1/m]
  Vector6T<S> rate = Vector6T<S>::Zero();          ///< of strain [1/s, 1/(m s)]
  Vector6T<S> delayed_rate = Vector6T<S>::Zero();  ///< what follows it with a relaxation time; the same units
};
using StrainMemory = StrainMemoryT<double>;

/// Rotation and curvature of a point of a beam; schemes whose interpolation depends on the past.
using PointRotation = InterpolatedRotation<double>;

struct State {
  double time = 0;                   ///< [s]
  Vector3 origin = Vector3::Zero();  ///< of positions of nodes, and of released translations in the world, from
                                     ///< Model::origin; it stays there unless Model::floats [m]
  std::vector<NodeState> nodes;      ///< slaves included
  std::vector<Released> released;    ///< per elementary joint
  std::vector<int> left_lines;       ///< joints that have slid off their lines, in the order in which they did
  std::vector<MassPointState> mass_points;
  std::vector<Vector6> strain_rates;  ///< per stiffness point; Newmark family with damping only
  // Empty unless the scheme needs them:
  std::vector<StrainMemory> strain_memory;                         ///< per stiffness point
  std::vector<PointRotation> stiffness_rotations, mass_rotations;  ///< per point
  std::vector<Vector3> total_rotations;  ///< per node: rotation vector from the undeformed state, continuous to 2 pi
  std::vector<Vector6> forces;           ///< per node: internal less external ones at the end of the last step
  std::vector<Vector6> reactions;        ///< per node: what joints transmitted to it in the last step
  std::vector<Vector3> momentum_rates;   ///< d(Lambda J W)/dt per mass point, then per node
  std::vector<double> commands;          ///< per coordinate: commanded effort, NaN where none holds
  std::vector<NodalLoad> wrenches;       ///< applied from outside, beside the scene's loads
  std::vector<double> efforts;           ///< per coordinate: applied in the last step
  std::vector<double> rests;             ///< per coordinate: 1 where dry friction stopped it in the last step, else 0
  std::vector<ActuatorState> actuators;  ///< per actuator
  IncrementHistory history;              ///< of the last sub-steps, for the predictor
  StepMeans drives;                      ///< what drove prescribed coordinates, for output
  StepMeans transmitted;                 ///< {force, moment} per Model::reactions, for output
  std::vector<double> last_transmitted;  ///< the same as the last step has it, for means of the Newmark family
  std::vector<SensorSample> samples;     ///< per sensor: what it measured last
  std::vector<double> force_memory;      ///< of force elements, one after the other
  double work = 0, dissipated = 0;       ///< path integrals since the start [J]
  int halving_level = 0;                 ///< sub-steps are step / 2^level
  int good_steps = 0;                    ///< converged sub-steps in a row at this level
  long steps = 0;                        ///< whole steps done
};

}  // namespace flexarm
