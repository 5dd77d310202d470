#pragma once
/// Makes markers for rviz of the grounds of a scene.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "pictures/floors.h"

namespace flexarm::messages {

/// Adds markers of the namespace `grounds`: for each ground a rectangle, and its grid.
void add_grounds(const std_msgs::Header& header, const std::vector<pictures::Floor>& floors,
                 visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
