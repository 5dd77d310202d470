#pragma once
/// The state of a mechanism: everything that changes with time. A copy of it is a checkpoint.

#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"
#include "model/actuator.h"
#include "model/beam_element.h"
#include "model/increment_history.h"
#include "model/joint.h"
#include "model/nodal_load.h"
#include "model/step_means.h"
#include "model/study_memory.h"

namespace flexarm {

/// Motion of a node. Angular quantities are material (in the node's frame).
struct NodeState {
  Vector3 position = Vector3::Zero();  ///< [m]
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();          ///< [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< W [rad/s]
  Vector3 mean_spin =
      Vector3::Zero();  ///< tangent-scaled rotation / step of the last step, world axes [rad/s]; energy-momentum family
  Vector3 acceleration = Vector3::Zero();          ///< [m/s^2]; Newmark family only
  Vector3 angular_acceleration = Vector3::Zero();  ///< A [rad/s^2]; Newmark family only
};

inline NodePose node_pose(const NodeState& node) {
  return {node.position, node.orientation, node.orientation.toRotationMatrix()};
}

/// Returns {v, w} in world axes.
inline Vector6 spatial_velocity(const NodeState& node) {
  Vector6 velocity;
  velocity << node.velocity, node.orientation * node.angular_velocity;
  return velocity;
}

/// Memory of numerical dissipation and structural damping at a stiffness point (NumericalDamper, StructuralDamper).
template <typename S>
struct StrainMemoryT {
  Vector6T<S> average = Vector6T<S>::Zero();       ///< moving average of strain increments [-, 1/m]
  Vector6T<S> rate = Vector6T<S>::Zero();          ///< strain rate [1/s, 1/(m s)]
  Vector6T<S> delayed_rate = Vector6T<S>::Zero();  ///< follows `rate` with a relaxation time [1/s, 1/(m s)]
};
using StrainMemory = StrainMemoryT<double>;

struct State {
  double time = 0;                    ///< [s]
  Vector3 origin = Vector3::Zero();   ///< origin of nodes' positions and of translations of free joints on the world,
                                      ///< relative to Model::origin; constant unless Model::floats [m]
  std::vector<NodeState> nodes;       ///< including slaves
  std::vector<Released> released;     ///< per elementary joint
  std::vector<int> left_lines;        ///< slides that have left their lines, in order of time
  std::vector<HalvedElement> halved;  ///< those of the model, in ascending order
  /// Per stiffness point, Model::maxwell_branches each: strains of the branches' springs [-, 1/m].
  std::vector<Vector6> branch_strains;
  std::vector<StrainMemory> strain_memory;  ///< per stiffness point; empty unless something damps or dissipates
  StudyMemory study;                        ///< what only the schemes for study store
  std::vector<double> commands;             ///< per coordinate: commanded effort; NaN: no command
  std::vector<NodalLoad> wrenches;          ///< applied by programs, in addition to the scene's loads
  std::vector<double> efforts;              ///< per coordinate: effort applied in the last step
  std::vector<double> rests;                ///< per coordinate: 1 if dry friction stopped it in the last step, else 0
  std::vector<ActuatorState> actuators;     ///< per actuator
  IncrementHistory history;                 ///< of the last sub-steps, for the predictor
  StepMeans drives;                         ///< efforts that drive prescribed coordinates, for output
  StepMeans transmitted;                    ///< {force, moment} per Model::reactions, for output
  std::vector<double> last_transmitted;  ///< as `transmitted`, at the end of the last step; for means, Newmark family
  std::vector<SensorSample> samples;     ///< per sensor: its last measurement
  std::vector<double> force_memory;      ///< memories of all force elements, one after the other
  double work = 0, dissipated = 0;       ///< path integrals since the start [J]
  int halving_level = 0;                 ///< the length of sub-steps is step / 2^level
  int good_steps = 0;                    ///< consecutive converged sub-steps at this level
  long steps = 0;                        ///< number of completed whole steps
};

}  // namespace flexarm
