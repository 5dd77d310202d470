#pragma once
/// Colours of markers.

#include <std_msgs/ColorRGBA.h>

#include "flexarm/math/pose.h"

namespace flexarm::messages {

std_msgs::ColorRGBA make_color(double red, double green, double blue, double alpha = 1);

/// The colour of a strain, given as a fraction (0 to 1) of the largest strain, as in pages (pictures/color_scale.h).
std_msgs::ColorRGBA strain_color(double part);

/// Shades a colour as if lit from above, since rviz does not light triangles that have their own colours.
std_msgs::ColorRGBA lit(std_msgs::ColorRGBA color, const Vector3& normal);

}  // namespace flexarm::messages
