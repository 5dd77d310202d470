#include "model/step_means.h"

#include <algorithm>

namespace flexarm {

void StepMeans::resize(std::size_t forces) {
  impulse.assign(forces, 0.0);
  for (std::vector<double>& mean : means) mean.assign(forces, 0.0);
  count = 0;
}

void StepMeans::begin() {
  std::fill(impulse.begin(), impulse.end(), 0.0);
}

void StepMeans::end(double duration) {
  std::rotate(means.begin(), means.end() - 1, means.end());
  for (std::size_t i = 0; i < impulse.size(); ++i) means[0][i] = impulse[i] / duration;
  count = std::min(count + 1, kLength);
}

void StepMeans::restart(const std::vector<double>& forces) {
  std::copy(forces.begin(), forces.end(), means[0].begin());
  count = 1;
}

double StepMeans::at_end(std::size_t i) const {
  if (count < 2) return means[0][i];
  // The mean of two steps has lost what alternates, and belongs to the step before ...
  if (count < 3) return 0.5 * (means[0][i] + means[1][i]);
  // ... from which the change of this mean leads on to the end of the last one.
  return means[0][i] + 0.5 * (means[1][i] - means[2][i]);
}

}  // namespace flexarm
