#pragma once
/// The legend of colours and arrows in rviz.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <vector>

#include "messages/arrows.h"
#include "pictures/scene_extent.h"

namespace flexarm::messages {

/// The arrows of one colour.
struct ArrowKind {
  std::string name;
  std_msgs::ColorRGBA color;
};

struct LegendContent {
  std::optional<double>
      largest_strain;  ///< strain at the bright end of the colours [-]; empty: nothing is coloured by strain
  ArrowScale arrows;
  std::vector<ArrowKind> kinds;  ///< kinds that may occur in the scene
};

/// Adds the legend at the left of the picture, beside the space that the scene can reach. It shows a vertical bar of
/// the colours with their strains. Below the bar are the longest arrow and the largest circle with their force and
/// moment, once there are any, and the colours of the kinds of arrows.
void add_legend(const std_msgs::Header& header, const pictures::SceneExtent& extent, const LegendContent& content,
                visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
