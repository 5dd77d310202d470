#pragma once
/// Surfaces that bend with a beam.

#include <visualization_msgs/Marker.h>

#include <array>
#include <vector>

#include "flexarm/math/pose.h"
#include "messages/triangle_mesh.h"

namespace flexarm::messages {

/// A mesh whose vertices hang on the sections of a beam: each on the two between which the nearest point of the
/// undeformed line lies, and moves as these carry it, in the parts by which it is nearer to one or the other. What is
/// beyond an end goes with that end's section.
class Skin {
 public:
  /// A part of a section's deformed state: where it is, and what is drawn in colour there.
  struct Section {
    Pose pose;
    double strain = 0;  ///< from 0 to 1, of the largest one
  };

  /// Triangles that reach over several sections are split, so that they bend.
  /// @param sections  at least two, undeformed, in the frame of the mesh
  Skin(const TriangleMesh& mesh, const std::vector<Pose>& sections);
  /// A tube around the line [m].
  static Skin tube(const std::vector<Pose>& sections, double radius);

  /// Appends it to a TRIANGLE_LIST with colours.
  /// @param sections  the same ones, deformed
  void draw(const std::vector<Section>& sections, visualization_msgs::Marker& marker);

 private:
  struct Place {
    int section = 0;  ///< the first of the two
    double part = 0;  ///< of the way to the second one
    double along() const { return section + part; }
  };
  struct Vertex {
    Place place;
    std::array<TriangleMesh::Vertex, 2> in_section;  ///< in the frames of the two
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
  std::vector<Matrix3> rotations_;  ///< scratch, of the sections
  std::vector<Corner> corners_;     ///< scratch, of the vertices
};

}  // namespace flexarm::messages
