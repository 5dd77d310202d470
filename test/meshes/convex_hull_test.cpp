// Tests convex hulls of points and of mesh files, and the errors of bad files.
#include "meshes/convex_hull.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "meshes/mesh_hulls.h"
#include "support/polytopes.h"

namespace flexarm::test::hulls {
namespace {

using meshes::convex_hull;
using meshes::simple_hull;

std::vector<Vector3> on_a_sphere(int count) {
  std::mt19937 generator(1);
  std::normal_distribution<double> number;
  std::vector<Vector3> out;
  for (int i = 0; i < count; ++i)
    out.push_back(Vector3(number(generator), number(generator), number(generator)).normalized());
  return out;
}

/// Checks that the corners of each face are in its plane, in counterclockwise order, and that all corners are inside of
/// all faces.
void expect_convex(const Polytope& body, double size) {
  for (const Polytope::Face& face : body.faces) {
    EXPECT_NEAR(face.normal.norm(), 1, 1e-14);
    const std::size_t count = face.corners.size();
    ASSERT_GE(count, 3u);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 &a = body.corners[face.corners[i]], &b = body.corners[face.corners[(i + 1) % count]],
                    &c = body.corners[face.corners[(i + 2) % count]];
      EXPECT_NEAR(height_over(face, a), 0, 2e-6 * size);  // planes that differ by a millionth count as one
      EXPECT_GT((b - a).cross(c - b).dot(face.normal), 0);
    }
    for (const Vector3& corner : body.corners) EXPECT_LT(height_over(face, corner), 2e-6 * size);
  }
  // Euler: corners - edges + faces = 2. Each edge belongs to two faces.
  std::size_t sides = 0;
  for (const Polytope::Face& face : body.faces) sides += face.corners.size();
  EXPECT_EQ(body.corners.size() + body.faces.size(), 2 + sides / 2);
}

TEST(ConvexHulls, OfABoxAreTheBox) {
  const Vector3 half(0.3, 0.2, 0.1);
  std::vector<Vector3> points = box_polytope(half).corners;
  points.emplace_back(0, 0, 0);
  points.emplace_back(0.1, 0.2, 0.05);  // inside a face
  const Polytope hull = convex_hull(points);
  EXPECT_EQ(hull.corners.size(), 8u);
  EXPECT_EQ(hull.faces.size(), 6u);
  expect_convex(hull, 0.8);
  for (const Polytope::Face& face : hull.faces) EXPECT_NEAR(face.offset, face.normal.cwiseAbs().dot(half), 1e-15);
  EXPECT_NEAR(inner_radius(hull), 0.1, 1e-15);
}

TEST(ConvexHulls, HoldAllPoints) {
  std::vector<Vector3> points = on_a_sphere(200);
  for (Vector3& point : points) point = point.cwiseProduct(Vector3(1, 0.5, 2)) + Vector3(3, 4, 5);
  const Polytope hull = convex_hull(points);
  EXPECT_EQ(hull.corners.size(), 200u);
  expect_convex(hull, 4);
}

// If 64 circles cover the unit sphere, each cap has the angle 2/8. The hull lacks 1 - cos there, and the tolerance
// allows four times this for uneven points.
TEST(ConvexHulls, WithFewCornersLackLittle) {
  const std::vector<Vector3> points = on_a_sphere(2000);
  const Polytope hull = simple_hull(points, 64);
  EXPECT_LE(hull.corners.size(), 64u);
  expect_convex(hull, 2);
  double lacks = 0;
  for (const Vector3& point : points)
    for (const Polytope::Face& face : hull.faces) lacks = std::max(lacks, height_over(face, point));
  EXPECT_LT(lacks, 4 * (1 - std::cos(0.25)));
}

TEST(ConvexHulls, OfWhatIsFlatAreRefused) {
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}), meshes::FlatPoints);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), meshes::FlatPoints);
  EXPECT_THROW(convex_hull({}), meshes::FlatPoints);
}

/// Writes a file with this text into the test folder and returns its path.
std::string written(const std::string& name, const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream(path) << text;
  return path;
}

std::string box_of_obj(const std::string& name, const Vector3& middle, int first) {
  std::string text = "o " + name + "\n";
  for (const Vector3& corner : box_polytope({0.5, 0.5, 0.5}).corners) {
    const Vector3 place = middle + corner;
    text += "v " + std::to_string(place.x()) + " " + std::to_string(place.y()) + " " + std::to_string(place.z()) + "\n";
  }
  for (const Polytope::Face& face : box_polytope({0.5, 0.5, 0.5}).faces) {
    text += "f";
    for (const int corner : face.corners) text += " " + std::to_string(first + corner);
    text += "\n";
  }
  return text;
}

TEST(MeshHulls, AreThoseOfEachMeshScaled) {
  const std::string path = written("two_boxes.obj", box_of_obj("a", {0, 0, 0}, 1) + box_of_obj("b", {3, 0, 0}, 9));
  const std::vector<Polytope> hulls = meshes::hulls_of_file(path, {1, 2, -1});
  ASSERT_EQ(hulls.size(), 2u);
  for (const Polytope& hull : hulls) {
    EXPECT_EQ(hull.corners.size(), 8u);
    expect_convex(hull, 3);
  }
  EXPECT_EQ(hulls[1].corners.front().cwiseAbs().y(), 1);
  EXPECT_GT(hulls[1].corners.front().x(), 2);
}

TEST(MeshHulls, OfBadFilesSayWhy) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      meshes::hulls_of_file(path, Vector3::Ones());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal("/nowhere/there.stl"), "none");
  EXPECT_NE(refusal(written("empty.stl", "")), "none");
  EXPECT_NE(refusal(written("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).find("volume"), std::string::npos);
}

}  // namespace
}  // namespace flexarm::test::hulls
