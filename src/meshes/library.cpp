#include "meshes/library.h"

#include "meshes/mesh_hulls.h"
#include "meshes/surface_mesh.h"

extern "C" const flexarm::meshes::Library flexarm_mesh_library;
const flexarm::meshes::Library flexarm_mesh_library = {flexarm::meshes::hulls_of_file,
                                                       flexarm::meshes::surface_of_file};
