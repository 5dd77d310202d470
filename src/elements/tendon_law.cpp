#include "elements/tendon_law.h"

#include <algorithm>
#include <cmath>

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

/// Adds a tension that resists the rate of the stretch, as far as the line does not push. `slope`: its derivative by
/// the stretch; `change`: of the stretch over the step.
void add_damper(double resists, double slope, double change, TendonStep& line) {
  double by_length = slope, by_rest = -slope;
  if (line.tension + resists < 0) {
    resists = -line.tension;
    by_length = -line.by_length;
    by_rest = -line.by_rest;
  }
  line.tension += resists;
  line.by_length += by_length;
  line.by_rest += by_rest;
  line.release -= resists;
  line.release_by_length -= by_length;
  line.release_by_rest -= by_rest;
  line.dissipated = resists * change;
}

}  // namespace

double TendonLaw::energy(const TendonLengths& line) const {
  const double stretch = std::max(line.length - line.rest, 0.0);
  return 0.5 * stiffness * stretch * stretch / line.rest;
}

double TendonLaw::tension(const TendonLengths& line) const {
  return stiffness * std::max(line.length / line.rest - 1, 0.0);
}

TendonStep TendonLaw::means(const TendonLengths& begin, const TendonLengths& end, double duration) const {
  TendonStep out;
  // The energy is EA/L0 times half the square of the stretch x. Going from begin to end along x and L0, one after the
  // other in both orders, gives a quotient for each; the stretch is never larger than at the ends.
  const double before = begin.length - begin.rest, after = end.length - end.rest;
  const Quotient square = of_half_square(before, after);
  const double stiff = 0.5 * stiffness * (1 / begin.rest + 1 / end.rest);
  out.tension = stiff * square.value;
  out.by_length = stiff * square.slope;
  out.by_rest = -out.by_length - 0.5 * stiffness * square.value / (end.rest * end.rest);
  const double old_stretch = std::max(before, 0.0), stretch = std::max(after, 0.0);
  const double inverse = stiffness / (begin.rest * end.rest);
  const double softening = -0.25 * inverse * (old_stretch * old_stretch + stretch * stretch);
  out.release = softening - out.tension;
  out.release_by_length = -0.5 * inverse * stretch - out.by_length;
  out.release_by_rest = 0.5 * inverse * stretch - softening / end.rest - out.by_rest;
  if (duration == 0 || damping == 0) return out;
  const double slope = after > 0 ? damping / duration : 0;
  add_damper(damping / duration * (stretch - old_stretch), slope, after - before, out);
  return out;
}

TendonStep TendonLaw::at_end(const TendonLengths& end, double rate, double rate_slope, double change) const {
  TendonStep out;
  if (!is_taut(end)) return out;
  const double ratio = end.length / end.rest;
  out.tension = stiffness * (ratio - 1);
  out.by_length = stiffness / end.rest;
  out.by_rest = -out.by_length * ratio;
  out.release = 0.5 * stiffness * (1 - ratio * ratio);
  out.release_by_length = -out.by_length * ratio;
  out.release_by_rest = out.by_length * ratio * ratio;
  add_damper(damping * rate, damping * rate_slope, change, out);
  return out;
}

}  // namespace flexarm
