#include "integrators/motion_kinks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// Differences of rates that count as jumps, relative to both of them. What remains alternates without harm: it changes
/// no mean of a step.
constexpr double kJump = 1e-2;
/// Round-off of a rate over two short sub-steps, as positions relative to the place [-] and absolute [m or rad].
constexpr double kRoundOff = 1e-10, kLeast = 1e-12;

}  // namespace

MotionKinks::MotionKinks(const Model& model, const Scheme& scheme) : model_(model), rate_(model) {
  places_.resize(model.coordinates.size());
  let_go();
  const bool alternates = !scheme.is_static && !scheme.tableau && scheme.is_incremental() && !scheme.backward_velocity;
  if (!alternates) return;
  for (std::size_t c = 0; c < model.coordinates.size(); ++c) {
    const Coordinate& coordinate = model.coordinates[c];
    if (coordinate.motion >= 0 && model.histories[coordinate.motion].may_have_corners())
      led_.push_back(static_cast<int>(c));
  }
}

bool MotionKinks::found(const State& state, double step) {
  const double h = kShort * step;
  bool jumps = false;
  for (const int c : led_) {
    const Coordinate& coordinate = model_.coordinates[c];
    const TimeFunction& motion = model_.histories[coordinate.motion];
    const double x0 = motion(state.time), x1 = motion(state.time + h), x2 = motion(state.time + 2 * h);
    const double from = rate_(model_, state, c), to = (3 * x2 - 4 * x1 + x0) / (2 * h), jump = std::abs(to - from);
    places_[c] = 0.5 * (x0 + x2) - 0.25 * h * (to - from);
    if (!(jump > kJump * (std::abs(from) + std::abs(to)))) continue;
    if (jump * step < kRoundOff * std::abs(x0) + kLeast) continue;
    // In smooth motion the rate lags behind by less than it changes in a step.
    const double end = state.time + step,
                 at_end = (3 * motion(end) - 4 * motion(end - h) + motion(end - 2 * h)) / (2 * h);
    jumps = jumps || jump > std::abs(at_end - to);
  }
  return jumps;
}

void MotionKinks::let_go() {
  std::fill(places_.begin(), places_.end(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace flexarm
