#include "pictures/floors.h"

#include <algorithm>
#include <cmath>

namespace flexarm::pictures {
namespace {

// In radii of the extent:
constexpr double kMargin = 0.2;    ///< around its shadow
constexpr double kSmallest = 0.6;  ///< half a floor's length or width
constexpr double kCells = 10;      ///< about so many in the extent's diameter

/// 1, 2 or 5 times a power of ten.
double round_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length))), rest = length / power;
  return power * (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10);
}

/// The floor in the plane normal · x = offset.
Floor floor_in(const Vector3& normal, double offset, const SceneExtent& extent) {
  const Quaternion turn = Quaternion::FromTwoVectors(Vector3::UnitZ(), normal);
  const Vector3 axes[] = {turn * Vector3::UnitX(), turn * Vector3::UnitY()};
  Floor floor{{offset * normal, turn}, 0, 0, round_length(2 * extent.radius / kCells)};
  double* const sizes[] = {&floor.length, &floor.width};
  for (int i = 0; i < 2; ++i) {
    const double middle = axes[i].dot(extent.center), shadow = axes[i].cwiseAbs().dot(extent.half);
    const double half = std::max(shadow + kMargin * extent.radius, kSmallest * extent.radius);
    const double first = std::floor((middle - half) / floor.cell), last = std::ceil((middle + half) / floor.cell);
    *sizes[i] = (last - first) * floor.cell;
    floor.pose.position += 0.5 * (first + last) * floor.cell * axes[i];
  }
  return floor;
}

}  // namespace

std::vector<Floor> floors_of(const std::vector<scene::GroundDescription>& grounds, const Vector3& up,
                             const SceneExtent& extent) {
  std::vector<Floor> floors;
  floors.reserve(grounds.size() + 1);
  for (const scene::GroundDescription& ground : grounds)
    floors.push_back(floor_in(ground.normal, ground.offset, extent));
  if (grounds.empty()) {
    floors.push_back(floor_in(up, 0, extent));
    floors.back().is_ground = false;
  }
  return floors;
}

Vector3 up_of(const Vector3& gravity) {
  return gravity.norm() > 0 ? Vector3(-gravity.normalized()) : Vector3(Vector3::UnitZ());
}

}  // namespace flexarm::pictures
