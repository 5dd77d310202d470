#include "building/stop_depths.h"

#include <algorithm>

namespace flexarm {
namespace {

/// Part of the range.
constexpr double kDepth = 0.1;
/// Where there is no range, of a radian or of the size of the mechanism.
constexpr double kDepthWithoutRange = 1e-4;
/// A start beyond a stop is this part of what it gives way at most: there it is nearly linear.
constexpr double kShareOfStart = 0.25;

void deepen(double& give, double start) {
  give = std::max(give, start / kShareOfStart);
}

}  // namespace

void set_stop_depths(Model& model) {
  for (Coordinate& coordinate : model.coordinates) {
    if (!coordinate.limit) continue;
    LimitStop& stop = *coordinate.limit;
    const JointMap& joint = model.joints[coordinate.joint];
    if (joint.kind == JointMapKind::Slide) {
      const SlideLine& line = model.slide_lines[joint.line];
      stop.give_below = SlideLine::kLargestOvershoot * line.pieces.front().length();
      stop.give_above = SlideLine::kLargestOvershoot * line.pieces.back().length();
      continue;
    }
    const double range = stop.upper - stop.lower,
                 start = model.initial_released[coordinate.joint].displacement[coordinate.component];
    const double scale = is_rotation(model, coordinate) ? 1.0 : model.length_scale;
    stop.give_below = stop.give_above = range > 0 ? kDepth * range : kDepthWithoutRange * scale;
    deepen(stop.give_below, stop.lower - start);
    deepen(stop.give_above, start - stop.upper);
  }
}

}  // namespace flexarm
