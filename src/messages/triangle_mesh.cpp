#include "messages/triangle_mesh.h"

#include <cmath>

#include "messages/conversions.h"
#include "pictures/shape_surface.h"

namespace flexarm::messages {
namespace {

Vector3 radial(int side) {
  const double angle = 2 * M_PI * side / kSides;
  return {0, std::cos(angle), std::sin(angle)};
}

/// Adds a cap. `forwards`: its outside faces along the section's x axis.
void add_cap(const Pose& section, double radius, bool forwards, TriangleMesh& mesh) {
  const Vector3 normal = section.orientation * Vector3(forwards ? 1 : -1, 0, 0);
  const int center = mesh.add(section.position, normal);
  for (int side = 0; side < kSides; ++side) mesh.add(section * (radius * radial(side)), normal);
  for (int side = 0; side < kSides; ++side) {
    const int first = center + 1 + side, second = center + 1 + (side + 1) % kSides;
    mesh.triangles.push_back({center, forwards ? first : second, forwards ? second : first});
  }
}

}  // namespace

int TriangleMesh::add(const Vector3& position, const Vector3& normal) {
  vertices.push_back({position, normal});
  return static_cast<int>(vertices.size()) - 1;
}

void TriangleMesh::add_quad(int a, int b, int c, int d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

void TriangleMesh::add(const TriangleMesh& other, const Pose& pose) {
  const int first = static_cast<int>(vertices.size());
  for (const Vertex& vertex : other.vertices) add(pose * vertex.position, pose.orientation * vertex.normal);
  for (const auto& [a, b, c] : other.triangles) triangles.push_back({first + a, first + b, first + c});
}

TriangleMesh tube_mesh(const std::vector<Pose>& sections, const std::vector<double>& radii) {
  TriangleMesh mesh;
  const int count = static_cast<int>(sections.size());
  if (count == 0) return mesh;
  for (int k = 0; k < count; ++k)
    for (int side = 0; side < kSides; ++side)
      mesh.add(sections[k] * (radii[k] * radial(side)), sections[k].orientation * radial(side));
  for (int k = 0; k + 1 < count; ++k)
    for (int side = 0; side < kSides; ++side) {
      const int next = (side + 1) % kSides, here = k * kSides, there = here + kSides;
      mesh.add_quad(here + side, here + next, there + next, there + side);
    }
  add_cap(sections.front(), radii.front(), false, mesh);
  add_cap(sections.back(), radii.back(), true, mesh);
  return mesh;
}

TriangleMesh box_mesh(const scene::BoxShape& box) {
  return {pictures::box_surface(box)};
}

TriangleMesh cylinder_mesh(const scene::CylinderShape& cylinder) {
  return {pictures::cylinder_surface(cylinder, kSides)};
}

TriangleMesh sphere_mesh(const scene::SphereShape& sphere) {
  return {pictures::sphere_surface(sphere, kSides, kSides / 2)};
}

void draw(const TriangleMesh& mesh, visualization_msgs::Marker& marker) {
  for (const TriangleMesh::Triangle& triangle : mesh.triangles)
    for (const int vertex : triangle) marker.points.push_back(to_point(mesh.vertices[vertex].position));
}

}  // namespace flexarm::messages
