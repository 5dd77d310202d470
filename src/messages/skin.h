#pragma once
/// A surface that bends with a beam.

#include <visualization_msgs/Marker.h>

#include <array>
#include <vector>

#include "flexarm/math/pose.h"
#include "messages/triangle_mesh.h"

namespace flexarm::messages {

/// A mesh whose vertices follow the sections of a beam. For each vertex, the nearest point of the undeformed centreline
/// is found, which lies between two sections. The vertex moves with both of them, weighted by how near the point is to
/// each. Vertices beyond an end of the beam move with the end's section.
class Skin {
 public:
  /// The deformed state of a section: its pose, and the strain that its colour shows.
  struct Section {
    Pose pose;
    double strain = 0;  ///< as a fraction (0 to 1) of the largest strain
  };

  /// Splits triangles that reach over several sections, so that they can bend.
  /// @param sections  at least two, undeformed, in the frame of the mesh
  Skin(const TriangleMesh& mesh, const std::vector<Pose>& sections);
  /// A tube around the line through the sections; `radius` [m].
  static Skin tube(const std::vector<Pose>& sections, double radius);

  /// Appends the surface to a marker of type TRIANGLE_LIST with colours.
  /// @param sections  the same sections as in the constructor, deformed
  void draw(const std::vector<Section>& sections, visualization_msgs::Marker& marker);

 private:
  struct Place {
    int section = 0;  ///< the first of two sections
    double part = 0;  ///< fraction of the way to the second section
    double along() const { return section + part; }
  };
  struct Vertex {
    Place place;
    std::array<TriangleMesh::Vertex, 2> in_section;  ///< in the frames of the two sections
  };
  struct Corner {
    geometry_msgs::Point point;
    std_msgs::ColorRGBA color;
  };
  class Splitter;

  Skin() = default;
  void attach(const TriangleMesh::Vertex& vertex, const Place& place, const std::vector<Pose>& sections);

  std::vector<Vertex> vertices_;
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<Matrix3> rotations_;  ///< scratch, one for each section
  std::vector<Corner> corners_;     ///< scratch, one for each vertex
};

}  // namespace flexarm::messages
