#pragma once
/// Draws forces and moments as arrows.

#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "flexarm/model/results.h"
#include "messages/triangle_mesh.h"

namespace flexarm::messages {

/// The largest force [N] and moment [N m] shown so far; the longest arrow and the largest circle stand for them.
struct ArrowScale {
  double force = 0, moment = 0;

  void note(const std::vector<ActingWrench>& wrenches);
};

/// A straight arrow for the force and a circular arrow for the moment, as surfaces in world coordinates. Leaves out an
/// arrow that would be too small to be seen. @param radius  of the scene [m]
TriangleMesh arrow_mesh(const ActingWrench& wrench, const ArrowScale& scale, double radius);

/// Length of the longest arrow and radius of the largest circle, per radius of the scene.
constexpr double kLongestArrow = 0.35, kLargestCircle = 0.15;

/// Adds one marker with this name that contains all arrows, if there are any.
void add_arrows(const std_msgs::Header& header, const std::string& name, const std::vector<ActingWrench>& wrenches,
                const ArrowScale& scale, double radius, const std_msgs::ColorRGBA& color,
                visualization_msgs::MarkerArray& message);

}  // namespace flexarm::messages
