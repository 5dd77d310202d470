#pragma once
/// The mesh of one flexible link: nodes along its centreline, elements between them.

#include <vector>

#include "flexarm/elements/beam_element.h"
#include "flexarm/model/centreline.h"
#include "flexarm/model/section.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// A node of the mesh in the undeformed link frame.
struct MeshNode {
  double arc_length = 0;
  Pose pose;            ///< origin in the mass centroid, axes of the section
  int welded_to = -1;   ///< at a kink: mesh node at the same point with the earlier section; -1: none
};

/// An element between mesh nodes.
struct MeshElement {
  std::vector<int> nodes;
  double end = 0;  ///< arc length
};

struct BeamMesh {
  SectionProperties section;       ///< referred to the mass centroid
  Vector3 centroid = Vector3::Zero();  ///< in the section, from the reference line
  int order = 2;
  std::vector<MeshNode> nodes;
  std::vector<MeshElement> elements;

  /// Mesh node at arc length s, which must be an element border.
  int node_at(double arc_length) const;
};

/// Number of elements of the given order for `elements="auto"`.
///
/// Rule: the first four clamped-free and pinned-pinned (bending) frequencies of a uniform straight beam within 1 % of the
/// exact ones, and at most a turning angle per element for which the static tip error of a circular arc stays below the
/// same 1 %. Both numbers were measured with the modes and statics tests (test/reference); an element border is also
/// placed where pieces of the centreline meet and where loads and joints attach.
int automatic_element_count(int order, double turning);

/// Meshes a link with element borders at `attachments` (arc lengths), piece borders and kinks.
BeamMesh mesh_beam(const scene::BeamDescription& beam, const Centreline& centreline, std::vector<double> attachments);

/// Constant data of an element from its nodes' undeformed poses; node indices, points' and blocks' offsets are left to
/// the caller.
template <int Nodes>
BeamElement<Nodes> beam_element(const BeamMesh& mesh, const MeshElement& element,
                                const scene::BeamDescription& beam);

}  // namespace flexarm
