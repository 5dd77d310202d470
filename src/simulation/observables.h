#pragma once
/// Read-only functions of a state for output: poses and stresses of points.

#include <vector>

#include "building/rigid_lines.h"
#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Points at every node and `between` equally spaced points inside each pair of nodes; appended to `points`.
void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points);

/// The sections of a rigid line whose link is there, without resultants; appended to `points`.
void rigid_points(const RigidLine& line, const Pose& link, std::vector<BeamPoint>& points);

/// The sections of the points of beam_points() in the model's initial configuration, in the link's frame; the link is
/// flexible.
std::vector<Pose> undeformed_sections(const Model& model, const LinkFrame& link, int between);

/// The largest strain of a beam's edge at its nodes, see edge_strain(), and the arc length where it is [m].
struct EdgeStrain {
  double amount = 0, arc_length = 0;
};
EdgeStrain largest_edge_strain(const Model& model, const State& state, const BeamLink& beam);

/// The section of a beam at the shape parameter `xi` of one of its elements.
BeamPoint section_point(const Model& model, const State& state, const BeamLink& beam, int element, double xi);

/// Strain of the fibre through a point of a beam's section, along the line, per length of the undeformed reference line
/// [-]. The point is inside an element.
double fibre_strain(const Model& model, const State& state, const ProbePoint& point);

/// About the origin of the state; of a point on the world, about that of the model.
Pose probe_pose(const Model& model, const State& state, const ProbePoint& probe);
/// Where in the world that is what probe_pose() is about.
Vector3 probe_origin(const Model& model, const State& state, const ProbePoint& probe);
Pose pose_in_world(const Model& model, const State& state, const ProbePoint& probe);
/// `velocities`: {v, w} per node, world axes.
ProbeState probe_state(const Model& model, const State& state, const std::vector<Vector6>& velocities,
                       const ProbePoint& probe);

/// Pose of a frame fixed to a node (or to the world).
Pose attached_pose(const State& state, const Attachment& attachment);

/// The state at the start: the model's initial configuration and velocities.
State initial_state(const Model& model);

}  // namespace flexarm
