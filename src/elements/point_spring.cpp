#include "elements/point_spring.h"

#include <fmt/format.h>

namespace flexarm {

std::string PointSpring::description() const {
  return fmt::format("{:.6g} N/m, slack at {:.6g} m, {:.6g} N s/m", law_.stiffness, law_.rest_length, law_.damping);
}

LineTension PointSpring::tension(const CoordinateStep& change) const {
  const double weight = change.at_end ? 1 : 0.5;
  const double length = (1 - weight) * change.begin + weight * change.end;
  LineTension out{law_.stiffness * (length - law_.rest_length), weight * law_.stiffness};
  if (change.step == 0 || law_.damping == 0) return out;
  const double rate = rate_of(change);
  out.value += law_.damping * rate;
  out.slope += law_.damping * rate_slope(change);
  out.dissipated = law_.damping * rate * change.increment;
  return out;
}

double PointSpring::energy(double length) const {
  const double stretch = length - law_.rest_length;
  return 0.5 * law_.stiffness * stretch * stretch;
}

LineTension PointSpring::elastic(double length) const {
  return {law_.stiffness * (length - law_.rest_length), law_.stiffness};
}

}  // namespace flexarm
