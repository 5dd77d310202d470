#include "meshes/surface_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <stdexcept>

#include "meshes/mesh_hulls.h"

namespace flexarm::meshes {
namespace {

/// Displays draw all triangles 25 times a second or more.
constexpr std::size_t kMostTriangles = 30000;
constexpr float kCrease = 40;  ///< edges with a smaller angle between their faces are drawn smooth [degrees]

/// Adds the meshes of a node and of its children. `placement`: from the parent node's frame to the file's.
void add_node(const aiScene& file, const aiNode& node, const aiMatrix4x4& placement, const Vector3& scale,
              SurfaceMesh& out) {
  const aiMatrix4x4 in_file = placement * node.mTransformation;
  const aiMatrix3x3 normals = aiMatrix3x3(in_file).Inverse().Transpose();
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *file.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(out.vertices.size());
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D p = in_file * mesh.mVertices[k], n = normals * mesh.mNormals[k];
      // Normals transform by the inverse scale. If that leaves no finite direction, any normal will do.
      const Vector3 normal = Vector3(n.x, n.y, n.z).cwiseQuotient(scale).normalized();
      out.vertices.push_back(
          {Vector3(p.x, p.y, p.z).cwiseProduct(scale), normal.allFinite() ? normal : Vector3::UnitZ()});
    }
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // a point or a line
      out.triangles.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                               first + static_cast<int>(face.mIndices[2])});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(file, *node.mChildren[i], in_file, scale, out);
}

}  // namespace

SurfaceMesh surface_of_file(const std::string& path, const Vector3& scale) {
  refuse_lfs_pointer(path);
  Assimp::Importer importer;
  keep_axes(importer);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const unsigned steps = aiProcess_Triangulate | aiProcess_DropNormals | aiProcess_GenSmoothNormals |
                         aiProcess_JoinIdenticalVertices | aiProcess_SortByPType;
  const aiScene* const file = importer.ReadFile(path, steps);
  if (!file || !file->mRootNode) throw std::runtime_error(importer.GetErrorString());
  SurfaceMesh mesh;
  add_node(*file, *file->mRootNode, aiMatrix4x4(), scale, mesh);
  for (const SurfaceMesh::Vertex& vertex : mesh.vertices)
    if (!vertex.position.allFinite()) throw std::runtime_error("a vertex of it is not finite");
  if (mesh.triangles.empty()) throw std::runtime_error("it has no triangles");
  if (mesh.triangles.size() > kMostTriangles)
    throw std::runtime_error("it has " + std::to_string(mesh.triangles.size()) + " triangles, more than " +
                             std::to_string(kMostTriangles));
  return mesh;
}

}  // namespace flexarm::meshes
