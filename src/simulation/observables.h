#pragma once
/// Read-only functions of a state for output: poses and stresses of points.

#include <vector>

#include "building/rigid_lines.h"
#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Appends to `points` every node, and `between` equally spaced points inside each pair of nodes.
void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points);

/// Appends to `points` the sections of a rigid line, without resultants. `link`: the pose of its link.
void rigid_points(const RigidLine& line, const Pose& link, std::vector<BeamPoint>& points);

/// Poses of the sections of beam_points() in the model's initial configuration, in the link's frame. The link is
/// flexible.
std::vector<Pose> undeformed_sections(const Model& model, const LinkFrame& link, int between);

/// The largest edge strain of a beam at its nodes (see edge_strain()), and its arc length [m].
struct EdgeStrain {
  double amount = 0, arc_length = 0;
};
EdgeStrain largest_edge_strain(const Model& model, const State& state, const BeamLink& beam);

/// The element of a beam that is bent most: by how much, without torsion and without the bends of the undeformed line
/// [rad], and its place in BeamLink::elements. An element of angle zero if none is bent by more than `limit`; looking
/// at such elements costs next to nothing.
struct ElementBending {
  double angle = 0;
  std::size_t element = 0;
};
ElementBending most_bent_element(const Model& model, const State& state, const BeamLink& beam, double limit);

/// The section of a beam at the parameter `xi` in [-1, 1] of one of its elements.
BeamPoint section_point(const Model& model, const State& state, const BeamLink& beam, int element, double xi);

/// Strain along the line of the fibre through a point of a beam's section, per length of the undeformed reference line
/// [-]. The point must be inside an element.
double fibre_strain(const Model& model, const State& state, const ProbePoint& point);

/// Pose relative to the origin of the state. For a point on the world, relative to the model's origin.
Pose probe_pose(const Model& model, const State& state, const ProbePoint& probe);
/// The world position of the origin to which probe_pose() is relative.
Vector3 probe_origin(const Model& model, const State& state, const ProbePoint& probe);
Pose pose_in_world(const Model& model, const State& state, const ProbePoint& probe);
/// `velocities`: {v, w} per node, world axes.
ProbeState probe_state(const Model& model, const State& state, const std::vector<Vector6>& velocities,
                       const ProbePoint& probe);

/// Pose of a frame fixed to a node (or to the world).
Pose attached_pose(const State& state, const Attachment& attachment);

/// The state at the start: the model's initial configuration and velocities.
State initial_state(const Model& model, double time = 0);

}  // namespace flexarm
