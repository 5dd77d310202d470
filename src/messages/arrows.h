#pragma once
/// Forces and moments as arrows.

#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "flexarm/model/results.h"
#include "messages/triangle_mesh.h"

namespace flexarm::messages {

/// What the longest arrow and the largest circle stand for: the largest force [N] and moment [N m] that were shown.
struct ArrowScale {
  double force = 0, moment = 0;

  void note(const std::vector<ActingWrench>& wrenches);
};

/// A straight arrow for the force, an arrow that goes around for the moment; none where they are too small to be seen.
/// Both are surfaces in the world. @param radius  of the scene [m]
TriangleMesh arrow_mesh(const ActingWrench& wrench, const ArrowScale& scale, double radius);

/// How long the longest arrow is, and how large the largest circle, as parts of the scene's radius.
constexpr double kLongestArrow = 0.35, kLargestCircle = 0.15;

/// Adds one marker of that name with all of them, if there are any.
void add_arrows(const std_msgs::Header& header, const std::string& name, const std::vector<ActingWrench>& wrenches,
                const ArrowScale& scale, double radius, const std_msgs::ColorRGBA& color,
                visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
