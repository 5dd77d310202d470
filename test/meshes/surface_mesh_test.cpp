// Tests surfaces of mesh files, and the errors of bad files.
#include "meshes/surface_mesh.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

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
