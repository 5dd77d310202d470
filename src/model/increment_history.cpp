#include "flexarm/model/increment_history.h"

#include <algorithm>
#include <cmath>

namespace flexarm {
namespace {
/// Of the sum of the weights' magnitudes; extrapolation of order two over equal steps has 3 + 3 + 1.
constexpr double kLargestSum = 7.5;
}  // namespace

std::vector<double>& IncrementHistory::push(double step, std::size_t unknowns) {
  for (std::vector<double>& increment : increments) increment.resize(unknowns);
  std::rotate(increments.begin(), increments.end() - 1, increments.end());
  std::rotate(steps.begin(), steps.end() - 1, steps.end());
  steps[0] = step;
  count = std::min(count + 1, kLength);
  return increments[0];
}

IncrementHistory::Weights IncrementHistory::weights(int order, int first, double step) const {
  Weights out{};
  if (first + order >= count) return out;
  std::array<double, kLength> middles{};
  double time = 0;
  for (int i = first; i <= first + order; ++i) {
    middles[i] = time - 0.5 * steps[i];
    time -= steps[i];
  }
  double sum = 0;
  for (int i = first; i <= first + order; ++i) {
    double value = step / steps[i];
    for (int k = first; k <= first + order; ++k)
      if (k != i) value *= (0.5 * step - middles[k]) / (middles[i] - middles[k]);
    out[i] = value;
    sum += std::abs(value);
  }
  return order == 0 || sum <= kLargestSum ? out : Weights{};
}

}  // namespace flexarm
