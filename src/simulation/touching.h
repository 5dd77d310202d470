#pragma once
/// Contacts and other force elements in a state, for output.

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

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

/// Appends what a force element of the model outputs. Allocates nothing after the first call of a thread.
inline void put_out(std::size_t element, const MotionView& view, PublishedMotion& motion, std::vector<double>& values) {
  const Model& model = view.model;
  const ForceElement& put = *model.force_elements.at(element);
  thread_local std::vector<double> rates;
  rates.clear();
  for (const int history : put.functions()) rates.push_back(model.histories[history].derivative(view.state.time));
  const double* memory = view.state.force_memory.data() + memory_begin(model.force_elements, element);
  put.put_out({view.state, motion.velocities(view).nodes(), memory, rates.data()}, values);
}

}  // namespace flexarm
