#pragma once
/// The hardening of a stop or contact with its penetration. (docs/notes/stops.md 2)

#include <algorithm>
#include <cmath>

namespace flexarm {

/// How deep something is penetrated, < 0 outside, and beyond which depth it gives way no further [m or rad].
struct Penetration {
  double depth, give;
  bool is_held = false;  ///< the law of the inside goes on outside
  bool is_felt() const { return depth > 0 || is_held; }
};

/// x = p / (1 - (p/give)^2)^2 of a penetration p, or the quotient of increments of both; derivatives by p at the end.
struct Hardened {
  double value = 0, slope = 0, curvature = 0;
};

/// Of `give`, at most what a state beyond all bounds counts for.
inline double share(const Penetration& p) {
  constexpr double kDeepest = 1 - 1e-6;
  return std::min(p.depth / p.give, kDeepest);
}

/// 1 - s^2, exact near s = 1.
inline double room(double s) {
  return (1 - s) * (1 + s);
}

inline Hardened hardened(const Penetration& p) {
  if (!p.is_felt()) return {};
  const double s = share(p), a = room(s);
  return {p.depth / (a * a), (1 + 3 * s * s) / (a * a * a), 12 * s * (1 + s * s) / (a * a * a * a) / p.give};
}

/// Quotient of the increments of hardened and true penetration, and its derivative with respect to the end.
inline Hardened quotient(const Penetration& begin, const Penetration& end) {
  // Increments whose quotients lose too much to round-off, relative to the way to where nothing gives way any further.
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
