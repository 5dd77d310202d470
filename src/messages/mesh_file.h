#pragma once
/// Surfaces from files.

#include "flexarm/scene/visual_description.h"
#include "messages/triangle_mesh.h"

namespace flexarm::messages {

/// Reads a mesh of any format that Assimp knows (STL, OBJ, Collada, ...), scaled, in the axes of the file.
/// @throws std::runtime_error saying why, if its URL is neither package:// nor file://, or the file cannot be read, has
///   no triangles, or too many for a display that draws them 25 times a second.
TriangleMesh read_mesh(const scene::MeshShape& shape);

}  // namespace flexarm::messages
