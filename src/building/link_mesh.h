#pragma once
/// The lines and meshes of single links, and what is said where they cannot be made (internal to building/).

#include <string>
#include <vector>

#include "building/beam_mesh.h"
#include "building/centreline.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// "file:line: element: ", with which messages about an element begin.
std::string at(const scene::SourceLocation& location, const std::string& element);

/// A link with a beam, undeformed.
struct LinkMesh {
  Centreline centreline;
  BeamMesh mesh;
};

/// @throws ModelError where the beam's centreline or order is impossible.
Centreline centreline_of(const scene::LinkDescription& link);

/// See mesh_beam().
/// @throws ModelError where there is no such mesh.
BeamMesh mesh_of(const scene::LinkDescription& link, const Centreline& centreline, const std::vector<double>& borders,
                 int most = scene::kMostBeamElements);

/// Arc lengths between which the load acts, where it names them [m].
/// @throws ModelError where they are beyond the line.
std::vector<double> ends_of(const scene::DistributedLoad& load, const Centreline& centreline);

}  // namespace flexarm
