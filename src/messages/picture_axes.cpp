#include "messages/picture_axes.h"

#include <cmath>

namespace flexarm::messages {
namespace {

// As in config/flexarm.rviz.
constexpr double kCameraYaw = 4.5, kCameraPitch = 0.5;

}  // namespace

PictureAxes picture_axes() {
  const double cp = std::cos(kCameraPitch), sp = std::sin(kCameraPitch);
  const Vector3 to_camera(std::cos(kCameraYaw) * cp, std::sin(kCameraYaw) * cp, sp);
  const Vector3 right(-std::sin(kCameraYaw), std::cos(kCameraYaw), 0);
  return {right, to_camera.cross(right), to_camera};
}

}  // namespace flexarm::messages
