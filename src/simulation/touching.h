#pragma once
/// Contacts in a state, for output.

#include <algorithm>
#include <functional>
#include <limits>

#include "simulation/published_motion.h"

namespace flexarm {

/// Calls `take(point)` for each TouchingPoint of a pair. Returns the smallest gap between the two bodies [m]. Allocates
/// nothing.
template <class Take>
double touch(const TouchingPair& pair, const MotionView& view, PublishedMotion& motion, Take&& take) {
  const TouchingPointTaker taker = std::ref(take);
  const std::vector<Vector6>& velocities = motion.velocities(view).nodes();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [index, memory] : pair.elements)
    least = std::min(least, view.model.force_elements[index]->touch(
                                {view.state, velocities, view.state.force_memory.data() + memory}, taker));
  return least;
}

}  // namespace flexarm
