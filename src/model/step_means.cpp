#include "model/step_means.h"

#include <algorithm>
#include <cassert>

namespace flexarm {

void StepMeans::resize(std::size_t forces) {
  impulse.assign(forces, 0.0);
  for (std::vector<double>& mean : means) mean.assign(forces, 0.0);
  count = 0;
}

void StepMeans::begin() {
  std::fill(impulse.begin(), impulse.end(), 0.0);
}

void StepMeans::begin_anew() {
  begin();
  count = 0;
}

void StepMeans::end(double duration) {
  assert(duration != 0 && means[0].size() == impulse.size());
  std::rotate(means.begin(), means.end() - 1, means.end());
  std::rotate(durations.begin(), durations.end() - 1, durations.end());
  durations[0] = duration;
  for (std::size_t i = 0; i < impulse.size(); ++i) means[0][i] = impulse[i] / duration;
  count = std::min(count + 1, kLength);
}

void StepMeans::restart(const std::vector<double>& forces) {
  assert(forces.size() == means[0].size());
  std::copy(forces.begin(), forces.end(), means[0].begin());
  durations[0] = 0;  // the forces are those at an instant
  count = 1;
}

double StepMeans::at_end(std::size_t i) const {
  assert(i < means[0].size());
  if (count < 2) return means[0][i];
  // The average of the last two means has no alternating part. It is the value at the beginning of the last step.
  if (count < 3) return 0.5 * (means[0][i] + means[1][i]);
  // Extrapolate this average to the end of the last step. For equal steps, its change over a step is half of the
  // difference between the newest and the oldest mean. For unequal steps, `beyond` accounts for the positions of their
  // midpoints.
  const auto [h0, h1, h2] = durations;
  const double beyond = (h0 - 0.5 * h1 - 0.5 * h2) / (0.5 * h0 + h1 + 0.5 * h2);
  return means[0][i] + 0.5 * (means[1][i] - means[2][i]) + 0.5 * beyond * (means[0][i] - means[2][i]);
}

}  // namespace flexarm
