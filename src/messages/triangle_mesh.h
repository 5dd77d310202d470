#pragma once
/// Surfaces for displays.

#include <visualization_msgs/Marker.h>

#include <array>
#include <cstddef>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/visual_description.h"

namespace flexarm::messages {

/// Triangles between vertices that know the normal of the surface, seen from outside anticlockwise. Where it has an
/// edge, there are several vertices at one place.
struct TriangleMesh {
  struct Vertex {
    Vector3 position, normal;
  };
  using Triangle = std::array<int, 3>;  ///< indices of vertices

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;

  int add(const Vector3& position, const Vector3& normal);
  void add_quad(int a, int b, int c, int d);
  /// The other one, placed in this one's frame.
  void add(const TriangleMesh& other, const Pose& pose);
};

/// Corners of a round section.
constexpr int kSides = 12;

/// A closed tube along x axes of poses; its radius changes linearly from each to the next [m]. At each pose are
/// `kSides` vertices, in their order; those of the two caps come behind them.
TriangleMesh tube_mesh(const std::vector<Pose>& sections, const std::vector<double>& radii);
TriangleMesh box_mesh(const scene::BoxShape& box);
TriangleMesh cylinder_mesh(const scene::CylinderShape& cylinder);
TriangleMesh sphere_mesh(const scene::SphereShape& sphere);

/// Appends it to a TRIANGLE_LIST without colours of its own, which rviz lights.
void draw(const TriangleMesh& mesh, visualization_msgs::Marker& marker);

}  // namespace flexarm::messages
