#include "joints/elasticity.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace flexarm {
namespace {

/// The part of a twist beyond the play, and its derivative with respect to the twist.
struct Deflection {
  double value, slope;
};

Deflection deflection(const Elasticity& elasticity, double twist) {
  assert(elasticity.backlash >= 0);
  const double beyond = std::abs(twist) - 0.5 * elasticity.backlash;
  if (beyond <= 0 && elasticity.backlash > 0) return {0, 0};
  return {std::copysign(beyond, twist), 1};
}

}  // namespace

PassiveEffort elastic_effort(const Elasticity& elasticity, const CoordinateStep& twist) {
  const auto& [stiffness, damping, backlash] = elasticity;
  const Deflection end = deflection(elasticity, twist.end);
  if (twist.step == 0) return {-stiffness * end.value, -stiffness * end.slope, 0};
  if (twist.at_end) {
    const double viscous = damping * end.slope * rate_of(twist);
    return {-(stiffness * end.value + viscous), -end.slope * (stiffness + damping * rate_slope(twist)),
            viscous * twist.increment};
  }
  const Deflection begin = deflection(elasticity, twist.begin);
  // If no kink is passed, the quotient of the increments is the slope. Else the quotient has no cancellation.
  const bool is_straight = begin.slope == end.slope && begin.value * end.value >= 0;
  const double change = begin.slope == 1 && is_straight ? twist.increment : end.value - begin.value;
  const double quotient = is_straight ? end.slope : change / twist.increment;
  const double quotient_slope = is_straight ? 0 : (end.slope - quotient) / twist.increment;
  const double mean = 0.5 * (begin.value + end.value), viscous = damping * change / twist.step;
  return {-(stiffness * mean * quotient + viscous),
          -(stiffness * (0.5 * end.slope * quotient + mean * quotient_slope) + damping * end.slope / twist.step),
          viscous * twist.increment};
}

ElasticInstant elastic_instant(const Elasticity& elasticity, double twist, double rate) {
  const Deflection now = deflection(elasticity, twist);
  const double viscous = elasticity.damping * now.slope * rate;
  return {-(elasticity.stiffness * now.value + viscous), viscous * rate};
}

double elastic_energy(const Elasticity& elasticity, double twist) {
  const double value = deflection(elasticity, twist).value;
  return 0.5 * elasticity.stiffness * value * value;
}

double elastic_damping(const Elasticity& elasticity, double twist) {
  return elasticity.damping * deflection(elasticity, twist).slope;
}

}  // namespace flexarm
