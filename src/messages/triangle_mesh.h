#pragma once
/// Triangle meshes for display.

#include <visualization_msgs/Marker.h>

#include <array>
#include <cstddef>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/visual_description.h"
#include "pictures/surface_meshes.h"

namespace flexarm::messages {

/// A surface that is put together from parts.
struct TriangleMesh : pictures::SurfaceMesh {
  using Triangle = std::array<int, 3>;  ///< indices of vertices

  int add(const Vector3& position, const Vector3& normal);
  void add_quad(int a, int b, int c, int d);
  /// Adds another mesh, with its pose in this one's frame.
  void add(const TriangleMesh& other, const Pose& pose);
};

/// Number of corners of a round section.
constexpr int kSides = 12;

/// A closed tube along the x axes of poses. Its radius [m] changes linearly from each pose to the next. Each pose has
/// `kSides` vertices, in the order of the poses; the vertices of the two caps follow.
TriangleMesh tube_mesh(const std::vector<Pose>& sections, const std::vector<double>& radii);
TriangleMesh box_mesh(const scene::BoxShape& box);
TriangleMesh cylinder_mesh(const scene::CylinderShape& cylinder);
TriangleMesh sphere_mesh(const scene::SphereShape& sphere);

/// Appends the mesh to a marker of type TRIANGLE_LIST without own colours, which rviz lights.
void draw(const TriangleMesh& mesh, visualization_msgs::Marker& marker);

}  // namespace flexarm::messages
