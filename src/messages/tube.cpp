#include "messages/tube.h"

#include <algorithm>
#include <cmath>

#include "messages/conversions.h"

namespace flexarm::messages {
namespace {

/// A colour under a light from above: rviz does not light triangles that have colours of their own.
std_msgs::ColorRGBA lit(std_msgs::ColorRGBA color, const Vector3& normal) {
  const Vector3 light = Vector3(-1, -2, 4).normalized();
  const auto brightness = static_cast<float>(0.75 + 0.25 * normal.dot(light));
  color.r *= brightness;
  color.g *= brightness;
  color.b *= brightness;
  return color;
}

}  // namespace

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
  Section section{pose, {}, color};
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2 * M_PI * side / kSides;
    const Vector3 normal = pose.orientation * Vector3(0, std::cos(angle), std::sin(angle));
    section.corners[side] = {to_point(pose.position + radius_ * normal), lit(color, normal)};
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

void Tube::add_triangle(const Corner& a, const Corner& b, const Corner& c) {
  for (const Corner* corner : {&a, &b, &c}) {
    marker_.points.push_back(corner->point);
    marker_.colors.push_back(corner->color);
  }
}

void Tube::add_wall(const Section& first, const Section& second) {
  for (int side = 0; side < kSides; ++side) {
    const int next = (side + 1) % kSides;
    add_triangle(first.corners[side], second.corners[side], second.corners[next]);
    add_triangle(first.corners[side], second.corners[next], first.corners[next]);
  }
}

void Tube::add_cap(const Section& section, bool forwards) {
  const std_msgs::ColorRGBA color = lit(section.color, section.pose.orientation * Vector3((forwards ? 1 : -1), 0, 0));
  for (int side = 0; side < kSides; ++side) {
    const auto& first = section.corners[side].point;
    const auto& second = section.corners[(side + 1) % kSides].point;
    add_triangle({to_point(section.pose.position), color}, {forwards ? first : second, color},
                 {forwards ? second : first, color});
  }
}

}  // namespace flexarm::messages
