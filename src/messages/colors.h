#pragma once
/// Colours of markers.

#include <std_msgs/ColorRGBA.h>

#include "flexarm/math/pose.h"

namespace flexarm::messages {

std_msgs::ColorRGBA make_color(double red, double green, double blue, double alpha = 1);

/// Of a part from 0 to 1 of the largest strain: blue, cyan, green, yellow, red, linear between.
std_msgs::ColorRGBA strain_color(double part);

/// A colour under a light from above: rviz does not light triangles that have colours of their own.
std_msgs::ColorRGBA lit(std_msgs::ColorRGBA color, const Vector3& normal);

}  // namespace flexarm::messages
