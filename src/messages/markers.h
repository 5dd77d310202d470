#pragma once
/// Helpers that all markers share.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <utility>

namespace flexarm::messages {

/// A marker of a type of visualization_msgs::Marker, in the frame of the header. `name` is its namespace, for which
/// rviz has a check box; `id` distinguishes markers of one namespace.
inline visualization_msgs::Marker make_marker(const std_msgs::Header& header, const std::string& name, int type,
                                              int id = 0) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
  return marker;
}

/// Adds a marker that consists of points, unless it has none: rviz warns about empty markers.
inline void add_if_any(visualization_msgs::Marker marker, visualization_msgs::MarkerArray& message) {
  if (!marker.points.empty()) message.markers.push_back(std::move(marker));
}

}  // namespace flexarm::messages
