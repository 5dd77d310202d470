#pragma once
/// Coloured tubes as triangles of a marker.

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <array>
#include <optional>
#include <string>

#include "flexarm/math/pose.h"

namespace flexarm::messages {

/// Blue, cyan, green, yellow, red for 0 to 1, linear between.
std_msgs::ColorRGBA make_color(double value);

/// A marker of a type of visualization_msgs::Marker, in the frame of its header.
visualization_msgs::Marker make_marker(const std_msgs::Header& header, const std::string& name, int type);

/// Draws a closed tube into a TRIANGLE_LIST, section by section; colours change linearly between them.
class Tube {
 public:
  /// @param radius  [m]
  Tube(visualization_msgs::Marker& marker, double radius) : marker_(marker), radius_(radius) {}

  /// The next section, in the marker's frame; its x axis is the tube's tangent.
  void add_section(const Pose& section, const std_msgs::ColorRGBA& color);
  /// After the last section.
  void close();

 private:
  static constexpr int kSides = 12;
  struct Corner {
    geometry_msgs::Point point;
    std_msgs::ColorRGBA color;
  };
  struct Section {
    Pose pose;
    std::array<Corner, kSides> corners;
    std_msgs::ColorRGBA color;
  };

  void add_triangle(const Corner& a, const Corner& b, const Corner& c);
  void add_wall(const Section& first, const Section& second);
  /// `forwards`: the outside looks along the tangent.
  void add_cap(const Section& section, bool forwards);

  visualization_msgs::Marker& marker_;
  double radius_;
  std::optional<Section> last_;
};

}  // namespace flexarm::messages
