#pragma once
/// The median of measurements.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace flexarm::bench {

/// For an even number of values, the mean of the two middle ones. NaN if there are no values.
inline double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace flexarm::bench
