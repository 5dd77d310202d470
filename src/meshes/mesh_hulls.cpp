#include "meshes/mesh_hulls.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <fstream>
#include <stdexcept>

#include "math/lfs_pointer.h"
#include "meshes/convex_hull.h"

namespace flexarm::meshes {

void refuse_lfs_pointer(const std::string& path) {
  std::string beginning(100, ' ');
  std::ifstream(path).read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (is_lfs_pointer(beginning)) throw std::runtime_error(kLfsPointerText);
}

void keep_axes(Assimp::Importer& importer) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
}

std::vector<Polytope> hulls_of_file(const std::string& path, const Vector3& scale) {
  refuse_lfs_pointer(path);
  Assimp::Importer importer;
  keep_axes(importer);
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, true);  // else all meshes would be merged
  const aiScene* const file = importer.ReadFile(path, aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
  if (!file) throw std::runtime_error(importer.GetErrorString());
  std::vector<Polytope> out;
  for (unsigned i = 0; i < file->mNumMeshes; ++i) {
    const aiMesh& mesh = *file->mMeshes[i];
    std::vector<Vector3> points;
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D& point = mesh.mVertices[k];
      points.push_back(Vector3(point.x, point.y, point.z).cwiseProduct(scale));
      if (!points.back().allFinite()) throw std::runtime_error("a vertex of it is not finite");
    }
    try {
      out.push_back(simple_hull(points, kMostCorners));
    } catch (const FlatPoints&) {  // flat meshes, such as labels on a body, are left out
    }
  }
  if (out.empty()) throw std::runtime_error("no mesh in it has a volume");
  return out;
}

}  // namespace flexarm::meshes
