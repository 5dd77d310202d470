#include "messages/ground_markers.h"

#include <cmath>
#include <utility>

#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/markers.h"

namespace flexarm::messages {
namespace {

constexpr const char* kGrounds = "grounds";
constexpr double kGridWidth = 0.02;   ///< of grid lines, per distance of two
constexpr double kThickness = 0.001;  ///< of the rectangle, per distance of grid lines
const std_msgs::ColorRGBA kGroundColor = make_color(0.45, 0.5, 0.58, 0.35);
const std_msgs::ColorRGBA kGridColor = make_color(0.6, 0.64, 0.7, 0.5);

/// Appends lines across a rectangle at equal distances; `along` is the half of each, `way` the way from the first one
/// to the last one.
void append_grid_lines(const Vector3& first, const Vector3& way, const Vector3& along, double cell,
                       std::vector<geometry_msgs::Point>& points) {
  const long count = std::lround(way.norm() / cell);
  for (long k = 0; k <= count; ++k) {
    const Vector3 middle = first + static_cast<double>(k) / static_cast<double>(count) * way;
    points.push_back(to_point(middle - along));
    points.push_back(to_point(middle + along));
  }
}

}  // namespace

void add_grounds(const std_msgs::Header& header, const std::vector<pictures::Floor>& floors,
                 visualization_msgs::MarkerArray& message) {
  int id = 0;
  for (const pictures::Floor& floor : floors) {
    if (!floor.is_ground) continue;
    visualization_msgs::Marker plane = make_marker(header, kGrounds, visualization_msgs::Marker::CUBE, id++);
    plane.pose = to_pose(floor.pose);
    plane.scale.x = floor.length;
    plane.scale.y = floor.width;
    plane.scale.z = kThickness * floor.cell;
    plane.color = kGroundColor;
    message.markers.push_back(std::move(plane));
    visualization_msgs::Marker grid = make_marker(header, kGrounds, visualization_msgs::Marker::LINE_LIST, id++);
    grid.pose = to_pose(floor.pose);
    grid.scale.x = kGridWidth * floor.cell;
    grid.color = kGridColor;
    const Vector3 x = 0.5 * floor.length * Vector3::UnitX(), y = 0.5 * floor.width * Vector3::UnitY();
    append_grid_lines(-x, 2 * x, y, floor.cell, grid.points);
    append_grid_lines(-y, 2 * y, x, floor.cell, grid.points);
    message.markers.push_back(std::move(grid));
  }
}

}  // namespace flexarm::messages
