#pragma once
/// The mesh of one flexible link: nodes along its centreline, elements between them.

#include <vector>

#include "building/centreline.h"
#include "building/section.h"
#include "flexarm/scene/scene_description.h"
#include "model/beam_element.h"
#include "scene/limits.h"

namespace flexarm {

/// A node of the mesh in the undeformed link frame.
struct MeshNode {
  double arc_length = 0;
  Pose pose;           ///< origin in the mass centroid, axes of the section
  int welded_to = -1;  ///< at a kink: mesh node at the same point with the earlier section; -1: none
};

/// An element between mesh nodes.
struct MeshElement {
  std::vector<int> nodes;
  double end = 0;  ///< arc length
  ElementPart part;
};

struct BeamMesh {
  SectionLine section;                 ///< of the reference line
  Vector3 centroid = Vector3::Zero();  ///< in the section, from the reference line
  int order = 2;
  std::vector<MeshNode> nodes;
  std::vector<MeshElement> elements;

  /// Mesh node at arc length s, which must be an element border.
  int node_at(double arc_length) const;
};

/// Number of elements of the given order for `elements="auto"`.
///
/// Rule: the fewest elements with which two errors are at most 1 %. First, the errors of the first four clamped-free
/// and the first four pinned-pinned bending frequencies of a slender uniform straight beam. Second, the error of the
/// static tip displacement of a circular arc of a quarter to half a turn, under a tip force in any direction. The
/// second one sets the largest turning of tangent and section per element; the limit was measured at the worst arc.
/// Tests check both (test/reference, automatic mesh). There are further element borders where pieces of the centreline
/// meet, and where loads and joints attach.
int automatic_element_count(int order, double turning);

/// The largest turning of an element in that rule [rad].
double turning_per_element(int order);

/// Meshes a link with element borders at `attachments` (arc lengths), piece borders and kinks.
/// Elements are halved as the beam says.
/// @throws std::invalid_argument if that takes more than `most` elements, or if the centre of mass is not in the same
/// place in all sections.
BeamMesh mesh_beam(const scene::BeamDescription& beam, const Centreline& centreline,
                   const std::vector<double>& attachments, int most = scene::kMostBeamElements);

/// Constant data of an element, from its nodes' undeformed poses. The caller sets node indices and the offsets of
/// points and blocks.
template <int Nodes>
BeamElement<Nodes> beam_element(const BeamMesh& mesh, const MeshElement& element, const scene::BeamDescription& beam);

}  // namespace flexarm
