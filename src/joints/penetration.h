#pragma once
/// The hardening law of stops and contacts. (docs/notes/stops.md 2)

#include <algorithm>
#include <cmath>

namespace flexarm {

/// The depth of a penetration (< 0 outside), and the largest depth possible (`give`) [m or rad].
struct Penetration {
  double depth, give;
  bool is_held = false;  ///< the law for depths > 0 is also used outside
  bool is_felt() const { return depth > 0 || is_held; }
};

/// The hardened penetration x = p / (1 - (p/give)^2)^2 for a depth p, or a quotient of increments of x and p.
/// Derivatives are with respect to p (at the end of a step).
struct Hardened {
  double value = 0, slope = 0, curvature = 0;
};

/// Returns depth / give, cut just below 1, so that states beyond the largest depth give finite numbers.
inline double share(const Penetration& p) {
  constexpr double kDeepest = 1 - 1e-6;
  return std::min(p.depth / p.give, kDeepest);
}

/// Returns 1 - s^2 without cancellation near s = 1.
inline double room(double s) {
  return (1 - s) * (1 + s);
}

inline Hardened hardened(const Penetration& p) {
  if (!p.is_felt()) return {};
  const double s = share(p), a = room(s);
  return {p.depth / (a * a), (1 + 3 * s * s) / (a * a * a), 12 * s * (1 + s * s) / (a * a * a * a) / p.give};
}

/// Returns the quotient of the increments of hardened and true penetration, and its derivative with respect to the
/// depth at the end.
inline Hardened quotient(const Penetration& begin, const Penetration& end) {
  // Increments below this, relative to the remaining way to the largest depth, have quotients with too much round-off.
  constexpr double kTiny = 1e-6;
  const double change = end.depth - begin.depth;
  const Hardened x0 = hardened(begin), x1 = hardened(end);
  if (!begin.is_felt() || !end.is_felt()) {
    const double value = (x1.value - x0.value) / change;
    return {value, (x1.slope - value) / change, 0};
  }
  const double s0 = share(begin), s1 = share(end), a = room(s0), b = room(s1);
  const double value = ((a + b) * (1 + s0 * s1) - a * b) / (a * a * b * b);
  const bool is_tiny = std::abs(change) <= kTiny * (end.give - end.depth);
  return {value, is_tiny ? 0.5 * x1.curvature : (x1.slope - value) / change, 0};
}

}  // namespace flexarm
