#include "marker_publisher.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "advertise.h"
#include "conversions.h"

namespace flexarm::node {
namespace {

constexpr int kSides = 12;              ///< of a tube
constexpr int kPointsBetweenNodes = 3;  ///< so that bending looks smooth

using Ring = std::array<geometry_msgs::Point, kSides>;

/// Corners of the tube around one section.
Ring make_ring(const Pose& section, double radius) {
  Ring ring;
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2 * M_PI * side / kSides;
    ring[side] = to_point(section * Vector3(0, radius * std::cos(angle), radius * std::sin(angle)));
  }
  return ring;
}

/// Blue over green to red for 0 to 1.
std_msgs::ColorRGBA make_color(double value) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(std::clamp(2 * value - 1, 0.0, 1.0));
  color.g = static_cast<float>(1 - std::abs(2 * value - 1));
  color.b = static_cast<float>(std::clamp(1 - 2 * value, 0.0, 1.0));
  color.a = 1;
  return color;
}

struct Vertex {
  geometry_msgs::Point point;
  std_msgs::ColorRGBA color;
};

void add_triangle(visualization_msgs::Marker& marker, const Vertex& a, const Vertex& b, const Vertex& c) {
  for (const Vertex* vertex : {&a, &b, &c}) {
    marker.points.push_back(vertex->point);
    marker.colors.push_back(vertex->color);
  }
}

/// The wall between two sections, outside facing outwards.
void add_wall(visualization_msgs::Marker& marker, const Ring& ring, const std_msgs::ColorRGBA& color,
              const Ring& next_ring, const std_msgs::ColorRGBA& next_color) {
  for (int side = 0; side < kSides; ++side) {
    const int next_side = (side + 1) % kSides;
    add_triangle(marker, {ring[side], color}, {next_ring[side], next_color}, {next_ring[next_side], next_color});
    add_triangle(marker, {ring[side], color}, {next_ring[next_side], next_color}, {ring[next_side], color});
  }
}

/// Closes an end; `forwards`: the outside looks along the tangent.
void add_cap(visualization_msgs::Marker& marker, const Ring& ring, const Vertex& center, bool forwards) {
  for (int side = 0; side < kSides; ++side) {
    const Vertex first{ring[side], center.color}, second{ring[(side + 1) % kSides], center.color};
    add_triangle(marker, center, forwards ? first : second, forwards ? second : first);
  }
}

}  // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate)
    : simulation_(simulation), schedule_(rate), largest_load_(simulation.link_names().size(), 0) {
  publisher_ =
      advertise<visualization_msgs::MarkerArray>(node, "beam_markers", 2, run, [this] { return make_message(stamp_); });
}

void MarkerPublisher::publish(const ros::Time& stamp, bool force) {
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  if (publisher_.getNumSubscribers() > 0) publisher_.publish(make_message(stamp));
}

visualization_msgs::MarkerArray MarkerPublisher::make_message(const ros::Time& stamp) {
  visualization_msgs::MarkerArray message;
  for (std::size_t link = 0; link < simulation_.link_names().size(); ++link) {
    if (!simulation_.is_flexible(link)) continue;
    visualization_msgs::Marker& marker = message.markers.emplace_back();
    marker.header.stamp = stamp;
    marker.header.frame_id = simulation_.scene().root_link;
    marker.ns = simulation_.link_names()[link];
    marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
    marker.action = visualization_msgs::Marker::ADD;
    marker.pose.orientation.w = 1;
    marker.scale.x = marker.scale.y = marker.scale.z = 1;
    marker.color.a = 1;
    draw_tube(link, marker);
  }
  return message;
}

void MarkerPublisher::draw_tube(std::size_t link, visualization_msgs::Marker& marker) {
  points_.clear();
  simulation_.beam_points(link, kPointsBetweenNodes, points_);
  if (points_.empty()) return;
  for (const BeamPoint& point : points_) largest_load_[link] = std::max(largest_load_[link], load(link, point));

  const double scale = largest_load_[link] > 0 ? 1 / largest_load_[link] : 0;
  const double radius = simulation_.beam_radius(link);
  Ring ring = make_ring(points_.front().pose, radius);
  std_msgs::ColorRGBA color = make_color(scale * load(link, points_.front()));
  add_cap(marker, ring, {to_point(points_.front().pose.position), color}, false);
  for (std::size_t next = 1; next < points_.size(); ++next) {
    const Ring next_ring = make_ring(points_[next].pose, radius);
    const std_msgs::ColorRGBA next_color = make_color(scale * load(link, points_[next]));
    add_wall(marker, ring, color, next_ring, next_color);
    ring = next_ring;
    color = next_color;
  }
  add_cap(marker, ring, {to_point(points_.back().pose.position), color}, true);
}

double MarkerPublisher::load(std::size_t link, const BeamPoint& point) const {
  return std::hypot(point.resultant.head<3>().norm(), point.resultant.tail<3>().norm() / simulation_.beam_radius(link));
}

}  // namespace flexarm::node
