#include "model/increment_history.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace flexarm {
namespace {
/// Largest sum of the magnitudes of the weights. For comparison: order two over equal steps has 3 + 3 + 1 = 7.
constexpr double kLargestSum = 7.5;
}  // namespace

bool IncrementHistory::holds_for(std::size_t unknowns) const {
  return count > 0 && std::all_of(increments.begin(), increments.begin() + count,
                                  [&](const std::vector<double>& made) { return made.size() == unknowns; });
}

std::vector<double>& IncrementHistory::push(double step, std::size_t unknowns) {
  if (!holds_for(unknowns)) clear();
  for (std::vector<double>& increment : increments) increment.resize(unknowns);
  std::rotate(increments.begin(), increments.end() - 1, increments.end());
  std::rotate(steps.begin(), steps.end() - 1, steps.end());
  steps[0] = step;
  count = std::min(count + 1, kLength);
  return increments[0];
}

IncrementHistory::Weights IncrementHistory::weights(int order, int first, double step) const {
  assert(order >= kNoMotion && order <= kHighestOrder && (first == 0 || first == 1));
  Weights out{};
  if (first + order >= count) return out;
  // Times of the ends of the steps, newest first, and of the beginning of the oldest one; the newest end is at time 0.
  // The predicted increment is that of the interpolation polynomial from 0 to `step`.
  std::array<double, kLength + 1> times{};
  for (int i = 0; i <= order; ++i) times[i + 1] = times[i] - steps[first + i];
  double sum = 0;
  for (int j = order + 1; j > 0; --j) {
    double lagrange = 1;
    for (int k = 0; k <= order + 1; ++k)
      if (k != j) lagrange *= (step - times[k]) / (times[j] - times[k]);
    // Relative to time 0, the position at times[j] is minus the sum of all later increments.
    for (int i = 0; i < j; ++i) out[first + i] -= lagrange;
  }
  for (const double weight : out) sum += std::abs(weight);
  return std::isfinite(sum) && (order == 0 || sum <= kLargestSum) ? out : Weights{};
}

}  // namespace flexarm
