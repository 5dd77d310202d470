#include "model/drive_efforts.h"

#include <algorithm>

namespace flexarm {

void DriveEfforts::resize(std::size_t coordinates) {
  impulse.assign(coordinates, 0.0);
  for (std::vector<double>& mean : means) mean.assign(coordinates, 0.0);
  count = 0;
}

void DriveEfforts::begin() {
  std::fill(impulse.begin(), impulse.end(), 0.0);
}

void DriveEfforts::end(double duration) {
  std::rotate(means.begin(), means.end() - 1, means.end());
  for (std::size_t i = 0; i < impulse.size(); ++i) means[0][i] = impulse[i] / duration;
  count = std::min(count + 1, kLength);
}

void DriveEfforts::restart(const std::vector<double>& efforts) {
  std::copy(efforts.begin(), efforts.end(), means[0].begin());
  count = 1;
}

double DriveEfforts::at_end(std::size_t i) const {
  if (count < 2) return means[0][i];
  // The mean of two steps has lost what alternates, and belongs to the step before ...
  if (count < 3) return 0.5 * (means[0][i] + means[1][i]);
  // ... from which the change of this mean leads on to the end of the last one.
  return means[0][i] + 0.5 * (means[1][i] - means[2][i]);
}

}  // namespace flexarm
