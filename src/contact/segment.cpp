#include "contact/segment.h"

#include <cmath>

namespace flexarm {

NearestOnSegment nearest_on(const Segment& segment, const ContactShape& shape) {
  const double curvature = segment.curvature, gap = shape.gap(segment.middle);
  constexpr double kFar = 1e100;  // squares of such distances overflow
  if (!(gap < kFar)) return {0, 0, gap, true};
  const auto slope_at = [&](double along) {
    return shape.distance(segment.at(along)).gradient.dot(segment.axis) + curvature * along;
  };
  NearestOnSegment out;
  // The distance from a convex shape is convex along the segment, so that its slope increases.
  double low = -segment.half, high = segment.half, low_slope = slope_at(low), high_slope = slope_at(high);
  out.is_end = low_slope >= 0 || high_slope <= 0;
  out.along = low_slope >= 0 ? low : high;
  constexpr int kMost = 100;
  constexpr double kFine = 1e-15;
  for (int i = 0; i < kMost && !out.is_end && high - low > kFine * segment.half; ++i) {
    // Regula falsi is fast where the slope is smooth; halving is safe where it jumps.
    const double part = i % 3 == 2 ? 0.5 : low_slope / (low_slope - high_slope);
    out.along = low + part * (high - low);
    const double slope = slope_at(out.along);
    if (slope == 0) break;
    (slope < 0 ? low : high) = out.along;
    (slope < 0 ? low_slope : high_slope) = slope;
  }
  out.rise = 0.5 * curvature * out.along * out.along;
  out.distance = shape.distance(segment.at(out.along)).value + out.rise;
  return out;
}

}  // namespace flexarm
