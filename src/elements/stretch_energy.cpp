#include "elements/stretch_energy.h"

#include <algorithm>

namespace flexarm {
namespace {

/// A difference quotient (f(end) - f(begin)) / (end - begin), and its derivative by `end`.
struct Quotient {
  double value = 0, slope = 0;
};

/// Of max(x, 0)^2 / 2.
Quotient of_half_square(double begin, double end) {
  if (begin >= 0 && end >= 0) return {0.5 * (begin + end), 0.5};
  if (begin <= 0 && end <= 0) return {};
  const double way = end - begin;
  if (end > 0) return {0.5 * end * end / way, end / way - 0.5 * end * end / (way * way)};
  return {-0.5 * begin * begin / way, 0.5 * begin * begin / (way * way)};
}

}  // namespace

double StretchEnergy::energy(const Stretch& at) const {
  const double stretch = std::max(at.stretch, 0.0);
  return 0.5 * stiffness * stretch * stretch / at.rest;
}

StretchForces StretchEnergy::means(const Stretch& begin, const Stretch& end) const {
  // The energy is k / L times half the square of the stretch x. Going from begin to end along x and L, one after the
  // other in both orders, gives a quotient for each; the stretch is never larger than at the ends.
  StretchForces out;
  const Quotient square = of_half_square(begin.stretch, end.stretch);
  const double stiff = 0.5 * stiffness * (1 / begin.rest + 1 / end.rest);
  out.force = stiff * square.value;
  out.force_by_stretch = stiff * square.slope;
  out.force_by_rest = -0.5 * stiffness * square.value / (end.rest * end.rest);
  const double old_stretch = std::max(begin.stretch, 0.0), stretch = std::max(end.stretch, 0.0);
  const double inverse = stiffness / (begin.rest * end.rest);
  out.release = -0.25 * inverse * (old_stretch * old_stretch + stretch * stretch);
  out.release_by_stretch = -0.5 * inverse * stretch;
  out.release_by_rest = -out.release / end.rest;
  return out;
}

StretchForces StretchEnergy::at(const Stretch& end) const {
  StretchForces out;
  if (!(end.stretch > 0)) return out;
  const double ratio = end.stretch / end.rest;
  out.force = stiffness * ratio;
  out.force_by_stretch = stiffness / end.rest;
  out.force_by_rest = -out.force / end.rest;
  out.release = -0.5 * stiffness * ratio * ratio;
  out.release_by_stretch = -out.force / end.rest;
  out.release_by_rest = -2 * out.release / end.rest;
  return out;
}

}  // namespace flexarm
