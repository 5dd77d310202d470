#pragma once
/// What the colours of the beams mean.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "messages/scene_extent.h"

namespace flexarm::messages {

/// Adds an upright bar of the colours, on the -x side of the scene, with the strains that they stand for.
/// @param largest  strain that is drawn red [-]
void add_strain_legend(const std_msgs::Header& header, const SceneExtent& extent, double largest,
                       visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
