#include "tube.h"

#include <algorithm>
#include <cmath>

#include "conversions.h"

namespace flexarm::node {

std_msgs::ColorRGBA make_color(double value) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(std::clamp(4 * value - 2, 0.0, 1.0));
  color.g = static_cast<float>(std::clamp(2 - std::abs(4 * value - 2), 0.0, 1.0));
  color.b = static_cast<float>(std::clamp(2 - 4 * value, 0.0, 1.0));
  color.a = 1;
  return color;
}

visualization_msgs::Marker make_marker(const std_msgs::Header& header, const std::string& name, int type) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
  return marker;
}

void Tube::add_section(const Pose& pose, const std_msgs::ColorRGBA& color) {
  Section section;
  section.center = to_point(pose.position);
  section.color = color;
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2 * M_PI * side / kSides;
    section.corners[side] = to_point(pose * Vector3(0, radius_ * std::cos(angle), radius_ * std::sin(angle)));
  }
  if (last_) {
    add_wall(*last_, section);
  } else {
    add_cap(section, false);
  }
  last_ = section;
}

void Tube::close() {
  if (last_) add_cap(*last_, true);
}

void Tube::add_corner(const geometry_msgs::Point& point, const std_msgs::ColorRGBA& color) {
  marker_.points.push_back(point);
  marker_.colors.push_back(color);
}

void Tube::add_wall(const Section& first, const Section& second) {
  for (int side = 0; side < kSides; ++side) {
    const int next = (side + 1) % kSides;
    add_corner(first.corners[side], first.color);
    add_corner(second.corners[side], second.color);
    add_corner(second.corners[next], second.color);
    add_corner(first.corners[side], first.color);
    add_corner(second.corners[next], second.color);
    add_corner(first.corners[next], first.color);
  }
}

void Tube::add_cap(const Section& section, bool forwards) {
  for (int side = 0; side < kSides; ++side) {
    const int next = (side + 1) % kSides;
    add_corner(section.center, section.color);
    add_corner(section.corners[forwards ? side : next], section.color);
    add_corner(section.corners[forwards ? next : side], section.color);
  }
}

}  // namespace flexarm::node
