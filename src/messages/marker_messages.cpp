#include "messages/marker_messages.h"

#include <algorithm>

#include "messages/strain_legend.h"
#include "messages/tube.h"

namespace flexarm::messages {
namespace {

constexpr int kPointsBetweenNodes = 3;  ///< so that bending looks smooth
/// Of a tube, as a part of the scene's radius: a rod of 3 mm by 2 m would be hard to see.
constexpr double kSmallestRadius = 0.008;
/// What is below is the round-off of a beam without load.
constexpr double kSmallestScale = 1e-9;

}  // namespace

MarkerMessages::MarkerMessages(const Simulation& simulation, const std::string& root_frame)
    : simulation_(simulation),
      root_frame_(root_frame),
      extent_(scene_extent(simulation)),
      points_(simulation.link_names().size()) {}

visualization_msgs::MarkerArray MarkerMessages::make(const ros::Time& stamp) {
  for (std::size_t link = 0; link < points_.size(); ++link) {
    points_[link].clear();
    simulation_.beam_points(link, kPointsBetweenNodes, points_[link]);
    const double radius = simulation_.beam_radius(link);
    for (const BeamPoint& point : points_[link])
      largest_strain_ = std::max(largest_strain_, edge_strain(point, radius));
  }
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = root_frame_;
  visualization_msgs::MarkerArray message;
  for (std::size_t link = 0; link < points_.size(); ++link) {
    if (points_[link].empty()) continue;
    message.markers.push_back(
        make_marker(header, simulation_.link_names()[link], visualization_msgs::Marker::TRIANGLE_LIST));
    draw_beam(link, message.markers.back());
  }
  if (!message.markers.empty()) add_strain_legend(header, extent_, largest_strain_, message);
  return message;
}

void MarkerMessages::draw_beam(std::size_t link, visualization_msgs::Marker& marker) const {
  const double radius = simulation_.beam_radius(link);
  const double scale = std::max(largest_strain_, kSmallestScale);
  Tube tube(marker, std::max(radius, kSmallestRadius * extent_.radius));
  for (const BeamPoint& point : points_[link])
    tube.add_section(point.pose, make_color(edge_strain(point, radius) / scale));
  tube.close();
}

}  // namespace flexarm::messages
