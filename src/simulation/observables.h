#pragma once
/// Read-only functions of a state for output: poses and stresses of points.

#include <vector>

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Points at every node and `between` equally spaced points inside each pair of nodes; appended to `points`.
void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points);

/// `velocities`: {v, w} per node, world axes.
ProbeState probe_state(const Model& model, const State& state, const std::vector<Vector6>& velocities,
                       const ProbePoint& probe);

/// Pose of a frame fixed to a node (or to the world).
Pose attached_pose(const State& state, const Attachment& attachment);

/// The state at the start: the model's initial configuration and velocities.
State initial_state(const Model& model);

}  // namespace flexarm
