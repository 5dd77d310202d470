#include "model/model.h"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace flexarm {

ElementPlace element_at(const BeamLink& beam, double arc_length) {
  assert(!beam.element_ends.empty());
  const std::vector<double>& ends = beam.element_ends;
  const auto found = std::lower_bound(ends.begin(), std::prev(ends.end()), arc_length - 1e-12 * beam.length);
  const double begin = found == ends.begin() ? 0.0 : *std::prev(found);
  return {static_cast<int>(found - ends.begin()), 2 * (arc_length - begin) / (*found - begin) - 1};
}

double mass_of(const Model& model) {
  double mass = 0;
  for (const NodalInertia& inertia : model.inertias) mass += inertia.total_mass;
  return mass;
}

}  // namespace flexarm
