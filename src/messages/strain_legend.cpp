#include "messages/strain_legend.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "messages/conversions.h"
#include "messages/tube.h"

namespace flexarm::messages {
namespace {

// Lengths as parts of the scene's radius.
constexpr double kDistance = 1.25;  ///< from the scene's centre
constexpr double kHalfHeight = 0.4;
constexpr double kBarRadius = 0.025;
constexpr double kTextHeight = 0.09;
constexpr double kTextDistance = 0.2;  ///< from the bar

constexpr const char* kName = "legend";

std::string percentage(double strain) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * strain);
  return text;
}

}  // namespace

void add_strain_legend(const std_msgs::Header& header, const SceneExtent& extent, double largest,
                       visualization_msgs::MarkerArray& message) {
  const Vector3 center = extent.center - kDistance * extent.radius * Vector3::UnitX();
  const Quaternion upright(Eigen::AngleAxisd(-M_PI / 2, Vector3::UnitY()));
  const auto height = [&](double value) { return (2 * value - 1) * kHalfHeight * extent.radius * Vector3::UnitZ(); };

  visualization_msgs::Marker bar = make_marker(header, kName, visualization_msgs::Marker::TRIANGLE_LIST);
  Tube tube(bar, kBarRadius * extent.radius);
  for (const double value : {0.0, 0.25, 0.5, 0.75, 1.0})
    tube.add_section({center + height(value), upright}, make_color(value));
  tube.close();
  message.markers.push_back(bar);

  const auto add_text = [&](const Vector3& position, const std::string& text) {
    visualization_msgs::Marker marker = make_marker(header, kName, visualization_msgs::Marker::TEXT_VIEW_FACING);
    marker.id = static_cast<int>(message.markers.size());
    marker.pose.position = to_point(position);
    marker.scale.z = kTextHeight * extent.radius;
    marker.text = text;
    message.markers.push_back(marker);
  };
  const Vector3 beside = center - kTextDistance * extent.radius * Vector3::UnitX();
  for (const double value : {0.0, 0.5, 1.0}) add_text(beside + height(value), percentage(value * largest));
  add_text(center + height(1) + 2 * kTextHeight * extent.radius * Vector3::UnitZ(), "edge strain");
}

}  // namespace flexarm::messages
