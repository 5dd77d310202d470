#include "messages/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <resource_retriever/retriever.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace flexarm::messages {
namespace {

constexpr std::size_t kMostTriangles = 30000;
constexpr float kCrease = 40;  ///< surfaces that meet at a smaller angle are drawn smooth [degrees]

resource_retriever::MemoryResource retrieved(const std::string& url) {
  const auto has_scheme = [&](const char* scheme) { return url.rfind(scheme, 0) == 0; };
  if (!has_scheme("package://") && !has_scheme("file://"))
    throw std::runtime_error("its URL must begin with package:// or file://");
  try {
    return resource_retriever::Retriever().get(url);
  } catch (const resource_retriever::Exception& error) {
    throw std::runtime_error(error.what());
  }
}

/// The meshes of a node and of those below it, whose frames are placed in the file's by `placement`.
void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& placement, const Vector3& scale,
              TriangleMesh& out) {
  const aiMatrix4x4 in_file = placement * node.mTransformation;
  const aiMatrix3x3 normals = aiMatrix3x3(in_file).Inverse().Transpose();
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(out.vertices.size());
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D p = in_file * mesh.mVertices[k], n = normals * mesh.mNormals[k];
      // Normals go by the inverse scale; where a direction has none left, the light hardly matters.
      const Vector3 normal = Vector3(n.x, n.y, n.z).cwiseQuotient(scale).normalized();
      out.add(Vector3(p.x, p.y, p.z).cwiseProduct(scale), normal.allFinite() ? normal : Vector3::UnitZ());
    }
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // points and lines
      out.triangles.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                               first + static_cast<int>(face.mIndices[2])});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], in_file, scale, out);
}

}  // namespace

TriangleMesh read_mesh(const scene::MeshShape& shape) {
  const resource_retriever::MemoryResource file = retrieved(shape.url);
  Assimp::Importer importer;
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const unsigned steps = aiProcess_Triangulate | aiProcess_DropNormals | aiProcess_GenSmoothNormals |
                         aiProcess_JoinIdenticalVertices | aiProcess_SortByPType;
  const std::string extension = std::filesystem::path(shape.url).extension();
  const aiScene* scene =
      importer.ReadFileFromMemory(file.data.get(), file.size, steps, extension.empty() ? "" : extension.c_str() + 1);
  if (!scene || !scene->mRootNode) throw std::runtime_error(importer.GetErrorString());
  TriangleMesh mesh;
  add_node(*scene, *scene->mRootNode, aiMatrix4x4(), shape.scale, mesh);
  for (const TriangleMesh::Vertex& vertex : mesh.vertices)
    if (!vertex.position.allFinite()) throw std::runtime_error("a vertex of it is not finite");
  if (mesh.triangles.empty()) throw std::runtime_error("it has no triangles");
  if (mesh.triangles.size() > kMostTriangles)
    throw std::runtime_error("it has " + std::to_string(mesh.triangles.size()) + " triangles, more than " +
                             std::to_string(kMostTriangles));
  return mesh;
}

}  // namespace flexarm::messages
