#pragma once
/// Read-only functions of a state for output: poses and stresses of points.

#include <vector>

#include "integrators/balance.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// One point of a deformed centreline: the reference line of the section, wherever its mass centroid lies.
struct BeamPoint {
  double arc_length = 0;                ///< of the undeformed line [m]
  Pose pose;                            ///< of the section, in the world; between nodes by the local interpolation
  Vector6 strain = Vector6::Zero();     ///< {Gamma, K} in the section frame [-, 1/m], by the scheme's interpolation
  Vector6 resultant = Vector6::Zero();  ///< {N, M} in the section frame [N, N m], elastic: without damping
};
/// Points at every node and `between` equally spaced points inside each pair of nodes; appended to `points`.
void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points);

/// Pose and velocity of a named point.
struct ProbeState {
  Pose pose;
  // Of second order in the step, see Simulation::velocity.
  Vector3 velocity = Vector3::Zero();          ///< world axes [m/s]
  Vector3 angular_velocity = Vector3::Zero();  ///< the same [rad/s]
};
/// `velocities`: {v, w} per node, world axes.
ProbeState probe_state(const Model& model, const State& state, const std::vector<Vector6>& velocities,
                       const ProbePoint& probe);

/// Pose of a frame fixed to a node (or to the world).
Pose attached_pose(const State& state, const Attachment& attachment);

/// The state at the start: the model's initial configuration and velocities.
State initial_state(const Model& model);

}  // namespace flexarm
