#include "messages/colors.h"

#include "pictures/color_scale.h"

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
  const auto [red, green, blue] = pictures::color_of_amount(part);
  return make_color(red, green, blue);
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
