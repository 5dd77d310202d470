#include "joints/joint_stop.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "joints/penetration.h"
#include "math/pi.h"

namespace flexarm {
namespace {

/// An update may penetrate a stop by at most this part of the remaining way to its largest penetration. After an update
/// that goes too deep, Newton's method comes back by only a sixth of the remaining way in each iteration.
constexpr double kLargestPart = 0.5;
/// Stop and coordinate form an oscillator. These are the largest phase angles by which a step may advance it. The angle
/// is smaller for forces at the end of the step, which are only of first order when the stop is touched and left.
constexpr double kLargestAngle = kPi / 5, kLargestAngleAtEnd = kPi / 16;
/// Largest change of the oscillation over a step, relative to its amplitude, that counts as resting on the stop.
constexpr double kSwing = 0.5;
/// Part of a hit over which the damper may take hold at most. Longer steps are halved.
constexpr double kLongestBlur = 0.1;
/// A step may cross at most this part of the remaining way to the largest penetration.
constexpr double kMuch = 0.1;

/// The effort against the penetration, and its derivatives with respect to the penetration at the end.
struct Push {
  double elastic = 0, elastic_slope = 0, viscous = 0, viscous_slope = 0;
  bool may_pull = false;

  bool pulls() const { return !may_pull && elastic + viscous < 0; }
  double value() const { return pulls() ? 0 : elastic + viscous; }
  double slope() const { return pulls() ? 0 : elastic_slope + viscous_slope; }
};

/// The mean push over a step. The elastic part is the discrete gradient of the energy, so it conserves energy. The
/// damper acts on the rate of the hardened penetration, so that the push is continuous at touch and release.
Push mean_push(const LimitStop& limit, const Penetration& begin, const Penetration& end, double step) {
  const double x0 = hardened(begin).value;
  const Hardened x1 = hardened(end), rise = quotient(begin, end);
  const double k = limit.stiffness, mean = 0.5 * (x0 + x1.value), change = rise.value * (end.depth - begin.depth);
  return {k * rise.value * mean, k * (rise.slope * mean + 0.5 * rise.value * x1.slope), limit.damping * change / step,
          limit.damping * x1.slope / step, end.is_held};
}

/// The rate that the damper feels, and its derivatives with respect to the hardened penetration and the rate.
struct FeltRate {
  double value, by_depth, by_rate;
};

/// With s = x / (rate blur), the damper feels (4 s - 3 s^2) rate until s = 1. The mean of this factor over s is 1, so
/// that the impulse is the same as without blur. (docs/notes/stops.md 4)
FeltRate felt_rate(const Penetration& at, double depth, double rate, double blur) {
  const double way = rate * blur;
  if (at.is_held || way <= depth) return {rate, 0, 1};
  const double s = depth / way;
  return {(4 - 3 * s) * s * rate, (4 - 6 * s) / blur, 3 * s * s};
}

/// The push at an instant.
Push push_at(const LimitStop& limit, double blur, const Penetration& at, double rate, double rate_slope) {
  const Hardened x = hardened(at);
  const double k = limit.stiffness, c = limit.damping;
  const FeltRate felt = felt_rate(at, x.value, rate, blur);
  return {k * x.slope * x.value, k * (x.slope * x.slope + x.curvature * x.value), c * x.slope * felt.value,
          c * (x.curvature * felt.value + x.slope * (felt.by_depth * x.slope + felt.by_rate * rate_slope)), at.is_held};
}

/// One side of a stop. `sign`: direction of its effort on the coordinate.
struct Side {
  double sign;
  Penetration begin, end;
  bool is_off = false;
};

std::array<Side, 2> sides(const LimitStop& limit, double begin, double end) {
  assert(limit.lower <= limit.upper && limit.give_below > 0 && limit.give_above > 0);
  return {Side{1, {limit.lower - begin, limit.give_below}, {limit.lower - end, limit.give_below}},
          Side{-1, {begin - limit.upper, limit.give_above}, {end - limit.upper, limit.give_above}}};
}

/// Whether the limits coincide and the coordinate is exactly there. Then both stops are touched and none is penetrated,
/// but a motion to either side is stopped by one of them.
bool is_pinned(const LimitStop& limit, double position) {
  return limit.lower == limit.upper && position == limit.upper;
}

/// Returns both sides with the laws that the step prescribes (CoordinateStep::below, above).
std::array<Side, 2> held_sides(const LimitStop& limit, const CoordinateStep& change) {
  std::array<Side, 2> both = sides(limit, change.begin, change.end);
  const auto hold = [](Side& side, StopContact contact) {
    side.begin.is_held = side.end.is_held = contact == StopContact::On;
    side.is_off = contact == StopContact::Off;
  };
  hold(both[0], change.below);
  hold(both[1], change.above);
  if (change.step == 0 && is_pinned(limit, change.end)) both[1].end.is_held = true;
  return both;
}

/// Circular frequency of the oscillator that the coordinate and an undamped stop form [rad/s].
double frequency(const LimitStop& limit) {
  return limit.inertia > 0 ? std::sqrt(limit.stiffness / limit.inertia) : 0.0;
}

/// Effort against the penetration at the end of the step. With Newmark's rule, its work over the step is that of the
/// mean of the efforts at both ends.
PassiveEffort effort_at_end(const LimitStop& limit, const Side& side, const CoordinateStep& change) {
  const double blur = std::min(change.blur, kLongestBlur * hit_time(limit));
  const Push begin = push_at(limit, blur, side.begin, -side.sign * change.begin_rate, 0);
  const Push end = push_at(limit, blur, side.end, -side.sign * rate_of(change), rate_slope(change));
  const double x0 = hardened(side.begin).value, x1 = hardened(side.end).value;
  const double stored = 0.5 * limit.stiffness * (x1 - x0) * (x1 + x0);
  const double work = 0.5 * (begin.value() + end.value()) * (side.end.depth - side.begin.depth);
  return {end.value(), end.slope(), work - stored};
}

PassiveEffort mean_effort(const LimitStop& limit, const Side& side, double step) {
  const Push push = mean_push(limit, side.begin, side.end, step);
  const double way = side.end.depth - side.begin.depth;
  return {push.value(), push.slope(), (push.pulls() ? -push.elastic : push.viscous) * way};
}

/// Effort of one side against the penetration.
PassiveEffort one_side(const LimitStop& limit, const Side& side, const CoordinateStep& change) {
  if (side.is_off || (!side.begin.is_felt() && !side.end.is_felt())) return {};
  if (change.step == 0) {
    const Push push = push_at(limit, 0, side.end, 0, 0);
    return {push.elastic, push.elastic_slope, 0};
  }
  if (change.at_end) return effort_at_end(limit, side, change);
  return mean_effort(limit, side, change.step);
}

}  // namespace

void LimitStop::carry(double moved_inertia) {
  assert(moved_inertia >= 0 && contact_time >= 0 && damping_ratio > 0);
  inertia = moved_inertia;
  if (contact_time > 0) {
    const double omega = kPi / contact_time;
    stiffness = inertia * omega * omega;
    damping = 2 * damping_ratio * inertia * omega;
  } else {
    damping = 2 * damping_ratio * std::sqrt(stiffness * inertia);
  }
}

double hit_time(const LimitStop& limit) {
  if (limit.contact_time > 0) return limit.contact_time;
  return limit.inertia > 0 ? kPi / frequency(limit) : 0.0;
}

PassiveEffort stop_effort(const LimitStop& limit, const CoordinateStep& change) {
  PassiveEffort out;
  for (const Side& side : held_sides(limit, change)) {
    const PassiveEffort push = one_side(limit, side, change);
    out.effort += side.sign * push.effort;
    out.slope -= push.slope;
    out.dissipated += push.dissipated;
  }
  return out;
}

StopReach stop_reach(const LimitStop& limit, bool is_above, double position, double rate) {
  Side side = sides(limit, position, position)[is_above];
  side.end.is_held = true;
  const double inward = -side.sign * rate, x = hardened(side.end).value;
  return {side.end.depth, inward, limit.stiffness * x + limit.damping * inward};
}

double stop_energy(const LimitStop& limit, double position) {
  double energy = 0;
  for (const Side& side : sides(limit, position, position))
    energy += 0.5 * limit.stiffness * std::pow(hardened(side.end).value, 2);
  return energy;
}

double stop_damping(const LimitStop& limit, double position) {
  double damping = 0;
  for (const Side& side : sides(limit, position, position)) damping += limit.damping * hardened(side.end).slope;
  return is_pinned(limit, position) ? limit.damping : damping;
}

double admissible_part(const LimitStop& limit, double from, double to) {
  double part = 1;
  for (const Side& side : sides(limit, from, to)) {
    const double inside = std::max(side.begin.depth, 0.0);
    const double deepest = inside + kLargestPart * (side.end.give - inside);
    if (side.end.depth > deepest && side.end.depth > side.begin.depth)
      part = std::min(part, (deepest - side.begin.depth) / (side.end.depth - side.begin.depth));
  }
  return std::max(part, 0.0);
}

bool is_coarse(const LimitStop& limit, const CoordinateStep& change, double refinement) {
  const double angle = refinement * frequency(limit) * std::abs(change.step);
  for (const Side& side : sides(limit, change.begin, change.end)) {
    if (side.begin.depth <= 0 && side.end.depth <= 0) continue;
    const double steepest = std::max(hardened(side.begin).slope, hardened(side.end).slope);
    if (change.at_end ? angle * steepest > kLargestAngleAtEnd
                      : angle * quotient(side.begin, side.end).value > kLargestAngle)
      return true;
  }
  return false;
}

bool swings(const LimitStop& limit, const CoordinateStep& change, double begin_rate, double refinement) {
  assert(change.step != 0 && refinement > 0);
  const double scale = frequency(limit), end_rate = 2 * change.increment / change.step - begin_rate;
  for (const Side& side : sides(limit, change.begin, change.end)) {
    if (side.begin.depth <= 0 && side.end.depth <= 0) continue;
    const double x0 = scale * hardened(side.begin).value, x1 = scale * hardened(side.end).value;
    const double largest = std::max(std::hypot(x0, begin_rate), std::hypot(x1, end_rate));
    if (refinement * std::hypot(x1 - x0, end_rate - begin_rate) > kSwing * largest) return true;
  }
  return false;
}

bool is_long_for_a_hit(const LimitStop& limit, const CoordinateStep& change, double begin_rate) {
  const double scale = frequency(limit);
  for (const Side& side : sides(limit, change.begin, change.begin)) {
    const double way = std::hypot(scale * hardened(side.begin).value, begin_rate) * std::abs(change.step);
    const double room = side.begin.give - std::max(side.begin.depth, 0.0);
    if (side.begin.depth + way > 0 && way > kMuch * room) return true;
  }
  return false;
}

}  // namespace flexarm
