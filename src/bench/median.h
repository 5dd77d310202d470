#pragma once
/// Of measurements.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace flexarm::bench {

/// The mean of both middle ones where they are even in number; NaN: there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace flexarm::bench
