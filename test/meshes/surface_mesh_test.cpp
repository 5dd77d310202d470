// Tests surfaces of mesh files, and the errors of bad files.
#include "meshes/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "meshes/mesh_hulls.h"

namespace flexarm::meshes {
namespace {

double volume(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.vertices[a].position.dot(mesh.vertices[b].position.cross(mesh.vertices[c].position)) / 6;
  return sum;
}

class SurfaceOfFile : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << content;
    return folder_ + "/" + name;
  }
  const std::string folder_ = ::testing::TempDir() + "flexarm_surface_mesh_test";
};

/// A tetrahedron with the corners 0, x, y, z, in millimetres.
const int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
const float kCorners[4][3] = {{0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, {0, 0, 1000}};

std::string ascii_stl() {
  std::string text = "solid tetrahedron\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : face)
      text += "vertex " + std::to_string(kCorners[k][0]) + " " + std::to_string(kCorners[k][1]) + " " +
              std::to_string(kCorners[k][2]) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

std::string binary_stl() {
  std::string bytes(80, ' ');
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(std::uint32_t(4));
  for (const auto& face : kFaces) {
    for (int k = 0; k < 3; ++k) append(0.0F);
    for (const int k : face)
      for (const float x : kCorners[k]) append(x);
    append(std::uint16_t(0));
  }
  return bytes;
}

std::string obj() {
  std::string text;
  for (const auto& [x, y, z] : kCorners)
    text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  for (const auto& [a, b, c] : kFaces)
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  return text;
}

TEST_F(SurfaceOfFile, IsReadAndScaled) {
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"ascii.stl", ascii_stl()},
                                      {"binary.stl", binary_stl()},
                                      {"BINARY.STL", binary_stl()},
                                      {"tetrahedron.obj", obj()}}) {
    const SurfaceMesh mesh = surface_of_file(write(name, content), {1e-3, 1e-3, 2e-3});
    EXPECT_EQ(mesh.triangles.size(), 4u) << name;
    EXPECT_NEAR(volume(mesh), 2 / 6.0, 1e-6) << name;  // single precision
    for (const SurfaceMesh::Vertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.normal.norm(), 1, 1e-6) << name;
  }
}

/// The tetrahedron with edges of 1, 2 and 3 m along x, y and z, in millimetres. `up`: the axis that the file calls up.
std::string collada(const std::string& up) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.001" name="millimeter"/><up_axis>)" +
         up + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="12">0 0 0 1000 0 0 0 2000 0 0 0 3000</float_array>
<technique_common><accessor source="#a" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

// Meshes of robots have z up. Their axes are those of the file, whichever one it calls up, as in rviz.
TEST_F(SurfaceOfFile, ColladaKeepsItsAxes) {
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    const std::string path = write(std::string(up) + ".dae", collada(up));
    Eigen::AlignedBox3d surface, body;
    for (const SurfaceMesh::Vertex& vertex : surface_of_file(path, Vector3::Ones()).vertices)
      surface.extend(vertex.position);
    const std::vector<Polytope> hulls = hulls_of_file(path, Vector3::Ones());
    ASSERT_EQ(hulls.size(), 1U);
    for (const Vector3& corner : hulls.front().corners) body.extend(corner);
    for (const Eigen::AlignedBox3d& box : {surface, body}) {
      EXPECT_LT(box.min().norm(), 1e-6) << up;  // single precision
      EXPECT_LT((box.max() - Vector3(1, 2, 3)).norm(), 1e-5) << up;
    }
  }
}

TEST_F(SurfaceOfFile, ThatCannotBeUsedSaysWhy) {
  const auto why = [](const std::string& path) -> std::string {
    try {
      surface_of_file(path, Vector3::Ones());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(why(folder_ + "/none.stl"), "");
  for (const char* name : {"empty.stl", "empty.obj", "empty", "empty.xyz"}) EXPECT_NE(why(write(name, "")), "") << name;
  EXPECT_NE(why(write("broken.stl", binary_stl().substr(0, 120))), "");
  EXPECT_NE(why(write("broken.dae", "<COLLADA")), "");
}

TEST_F(SurfaceOfFile, SaysThatGitLfsHasNotFetchedIt) {
  const std::string path =
      write("pointer.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n");
  try {
    surface_of_file(path, Vector3::Ones());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "this is a Git LFS pointer, not the file: 'git lfs pull' fetches it");
  }
}

}  // namespace
}  // namespace flexarm::meshes
