#include "messages/colors.h"

#include <algorithm>
#include <cmath>

namespace flexarm::messages {

std_msgs::ColorRGBA make_color(double red, double green, double blue, double alpha) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red);
  color.g = static_cast<float>(green);
  color.b = static_cast<float>(blue);
  color.a = static_cast<float>(alpha);
  return color;
}

std_msgs::ColorRGBA strain_color(double part) {
  const auto clamped = [](double value) { return std::clamp(value, 0.0, 1.0); };
  return make_color(clamped(4 * part - 2), clamped(2 - std::abs(4 * part - 2)), clamped(2 - 4 * part));
}

std_msgs::ColorRGBA lit(std_msgs::ColorRGBA color, const Vector3& normal) {
  static const Vector3 light = Vector3(-1, -2, 4).normalized();
  const auto brightness = static_cast<float>(0.75 + 0.25 * normal.dot(light));
  color.r *= brightness;
  color.g *= brightness;
  color.b *= brightness;
  return color;
}

}  // namespace flexarm::messages
