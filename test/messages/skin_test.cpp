// Tests surfaces that bend with beams, and the shapes of rigid bodies.
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "messages/skin.h"

namespace flexarm::messages {
namespace {

constexpr int kSections = 41;
constexpr double kLength = 2;
// Error of a chord between two sections on an arc of radius R: (L/n)^2/(8 R). Points beside the line have the same
// error again.
constexpr double kRadius = 1.5, kChord = (kLength / (kSections - 1)) * (kLength / (kSections - 1)) / (8 * kRadius);

std::vector<Pose> straight_line() {
  std::vector<Pose> sections;
  for (int k = 0; k < kSections; ++k)
    sections.push_back({kLength * k / (kSections - 1) * Vector3::UnitX(), Quaternion::Identity()});
  return sections;
}

/// Returns a section of the line, bent to a circle in the x-y plane.
Pose bent(double s) {
  const double angle = s / kRadius;
  return {{kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0},
          Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()))};
}

std::vector<Skin::Section> bent_line() {
  std::vector<Skin::Section> sections;
  for (int k = 0; k < kSections; ++k) sections.push_back({bent(kLength * k / (kSections - 1)), k / (kSections - 1.0)});
  return sections;
}

Vector3 corner(const visualization_msgs::Marker& marker, std::size_t k) {
  return {marker.points[k].x, marker.points[k].y, marker.points[k].z};
}

double area(const visualization_msgs::Marker& marker) {
  double sum = 0;
  for (std::size_t k = 0; k < marker.points.size(); k += 3)
    sum += 0.5 * (corner(marker, k + 1) - corner(marker, k)).cross(corner(marker, k + 2) - corner(marker, k)).norm();
  return sum;
}

/// Returns the volume inside a closed surface.
double volume(const visualization_msgs::Marker& marker) {
  double sum = 0;
  for (std::size_t k = 0; k < marker.points.size(); k += 3)
    sum += corner(marker, k).dot(corner(marker, k + 1).cross(corner(marker, k + 2))) / 6;
  return sum;
}

visualization_msgs::Marker drawn(Skin skin, const std::vector<Skin::Section>& sections) {
  visualization_msgs::Marker marker;
  skin.draw(sections, marker);
  EXPECT_EQ(marker.points.size(), marker.colors.size());
  return marker;
}

std::vector<Skin::Section> unloaded(const std::vector<Pose>& poses) {
  std::vector<Skin::Section> sections;
  for (const Pose& pose : poses) sections.push_back({pose, 0});
  return sections;
}

TriangleMesh long_box() {
  TriangleMesh mesh;
  mesh.add(box_mesh({{kLength, 0.2, 0.1}}), {kLength / 2 * Vector3::UnitX(), Quaternion::Identity()});
  return mesh;
}

TEST(Skin, OfAnUndeformedBeamIsTheMesh) {
  const visualization_msgs::Marker box = drawn(Skin(long_box(), straight_line()), unloaded(straight_line()));
  EXPECT_GT(box.points.size(), 3u * 12);  // the box was split
  EXPECT_NEAR(volume(box), kLength * 0.2 * 0.1, 1e-12);
  EXPECT_NEAR(area(box), 2 * (kLength * 0.2 + kLength * 0.1 + 0.2 * 0.1), 1e-12);
}

// Each corner moves with its section. Sections stay plane, so the volume is unchanged.
TEST(Skin, BendsWithTheBeam) {
  const visualization_msgs::Marker straight = drawn(Skin(long_box(), straight_line()), unloaded(straight_line()));
  const visualization_msgs::Marker box = drawn(Skin(long_box(), straight_line()), bent_line());
  ASSERT_EQ(box.points.size(), straight.points.size());
  for (std::size_t k = 0; k < box.points.size(); ++k) {
    const Vector3 at = corner(straight, k);
    EXPECT_LT((corner(box, k) - bent(at.x()) * Vector3(0, at.y(), at.z())).norm(), 2 * kChord);
  }
  EXPECT_NEAR(volume(box), kLength * 0.2 * 0.1, 0.01 * kLength * 0.2 * 0.1);
}

TEST(Skin, HasNoGaps) {
  TriangleMesh mesh = long_box();
  mesh.add(sphere_mesh({0.3}), {Vector3(0.7, 0.1, 0), Quaternion::Identity()});
  const visualization_msgs::Marker marker = drawn(Skin(mesh, straight_line()), bent_line());
  // Each edge of a triangle occurs once in each direction.
  const auto rounded = [](const Vector3& p) {
    return std::array<long, 3>{std::lround(p.x() * 1e9), std::lround(p.y() * 1e9), std::lround(p.z() * 1e9)};
  };
  std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> ways;
  for (std::size_t k = 0; k < marker.points.size(); ++k) {
    const auto a = rounded(corner(marker, k)), b = rounded(corner(marker, k % 3 == 2 ? k - 2 : k + 1));
    if (a == b) continue;  // at a pole
    ++ways[{a, b}];
    --ways[{b, a}];
  }
  for (const auto& [way, count] : ways) EXPECT_EQ(count, 0);
}

TEST(Skin, GoesWithTheEndsBeyondThem) {
  TriangleMesh mesh;
  mesh.add(box_mesh({{0.4, 0.2, 0.2}}), {Vector3(kLength + 0.5, 0, 0), Quaternion::Identity()});
  const visualization_msgs::Marker box = drawn(Skin(mesh, straight_line()), bent_line());
  EXPECT_EQ(box.points.size(), 3u * 12);
  EXPECT_NEAR(volume(box), 0.4 * 0.2 * 0.2, 1e-12);
  Vector3 middle = Vector3::Zero();
  for (std::size_t k = 0; k < box.points.size(); ++k) middle += corner(box, k) / static_cast<double>(box.points.size());
  // Each face has two triangles: two opposite corners of a face count twice as much as the other two.
  EXPECT_LT((middle - bent(kLength) * Vector3(0.5, 0, 0)).norm(), 0.2);
}

TEST(Skin, OfATubeFollowsEachTurnOfACoil) {
  std::vector<Pose> coil;
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.2 * k;
    const Vector3 tangent = Vector3(-std::sin(angle), std::cos(angle), 0.01).normalized();
    coil.push_back(
        {{std::cos(angle), std::sin(angle), 0.002 * k}, Quaternion::FromTwoVectors(Vector3::UnitX(), tangent)});
  }
  const visualization_msgs::Marker tube = drawn(Skin::tube(coil, 0.1), unloaded(coil));
  for (std::size_t k = 0; k < 199 * 2 * 3 * kSides; ++k) {
    const std::size_t first = k / (2 * 3 * kSides);
    const double distance =
        std::min((corner(tube, k) - coil[first].position).norm(), (corner(tube, k) - coil[first + 1].position).norm());
    ASSERT_NEAR(distance, 0.1, 1e-12);
  }
}

TEST(Skin, IsBounded) {
  TriangleMesh huge;
  huge.add(box_mesh({{1e9, 1e9, 1e9}}), Pose());
  EXPECT_LE(drawn(Skin(huge, straight_line()), bent_line()).points.size(), 3u * 60100);
}

TEST(Shapes, AreClosedAndOfTheirSize) {
  const auto marker_of = [](const TriangleMesh& mesh) {
    visualization_msgs::Marker marker;
    draw(mesh, marker);
    return marker;
  };
  const double polygon = 0.5 * kSides * std::sin(2 * M_PI / kSides);  // area of the polygon for a radius of 1
  EXPECT_NEAR(volume(marker_of(box_mesh({{1, 2, 3}}))), 6, 1e-12);
  EXPECT_NEAR(volume(marker_of(cylinder_mesh({0.5, 3}))), 3 * 0.25 * polygon, 1e-12);
  const double sphere = volume(marker_of(sphere_mesh({1})));
  EXPECT_GT(sphere, 0.85 * 4 / 3 * M_PI);
  EXPECT_LT(sphere, 4 / 3.0 * M_PI);
}

}  // namespace
}  // namespace flexarm::messages
