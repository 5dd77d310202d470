#include "elements/tendon_law.h"

#include <algorithm>

#include "elements/stretch_energy.h"

namespace flexarm {
namespace {

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
  const double before = begin.length - begin.rest, after = end.length - end.rest;
  const StretchForces line = StretchEnergy{stiffness}.means({before, begin.rest}, {after, end.rest});
  out.tension = line.force;
  out.by_length = line.force_by_stretch;
  out.by_rest = -line.force_by_stretch + line.force_by_rest;
  out.release = line.release - out.tension;
  out.release_by_length = line.release_by_stretch - out.by_length;
  out.release_by_rest = -line.release_by_stretch + line.release_by_rest - out.by_rest;
  if (duration == 0 || damping == 0) return out;
  const double slope = after > 0 ? damping / duration : 0;
  const double change = std::max(after, 0.0) - std::max(before, 0.0);
  add_damper(damping / duration * change, slope, after - before, out);
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
