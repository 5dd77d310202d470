#pragma once
/// What colours and arrows mean.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <vector>

#include "messages/arrows.h"
#include "messages/scene_extent.h"

namespace flexarm::messages {

/// Arrows of one colour.
struct ArrowKind {
  std::string name;
  std_msgs::ColorRGBA color;
};

struct LegendContent {
  std::optional<double> largest_strain;  ///< that is drawn red [-]; none: nothing has these colours
  ArrowScale arrows;
  std::vector<ArrowKind> kinds;  ///< that the scene may have
};

/// Adds the legend, at the left of the picture, beside all that the scene reaches: an upright bar of the colours with
/// the strains that they stand for, below it the longest arrow and the largest circle with the force and the moment
/// that they stand for, once there are some, and the colours of the kinds of arrows.
void add_legend(const std_msgs::Header& header, const SceneExtent& extent, const LegendContent& content,
                visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
