#include "integrators/smooth_reversals.h"

#include <algorithm>
#include <cmath>

#include "joints/joint_forces.h"

namespace flexarm {
namespace {

/// Number of Newton updates per attempt in which smooth friction may stop at rate zero.
constexpr int kMostStoppedUpdates = 3;

}  // namespace

SmoothReversals::SmoothReversals(StepConfiguration& configuration) : configuration_(configuration) {
  if (configuration.scheme().is_static) return;
  const DegreesOfFreedom& dof = configuration.degrees_of_freedom();
  const std::vector<Coordinate>& coordinates = configuration.model().coordinates;
  for (std::size_t index = 0; index < coordinates.size(); ++index) {
    const Coordinate& coordinate = coordinates[index];
    const bool rubs = coordinate.friction > 0 || coordinate.friction_coefficient > 0;
    const int equation = dof.equation[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component];
    if (rubs && !coordinate.sticks && equation >= 0 && !coordinate.is_angle)
      coordinates_.push_back(static_cast<int>(index));
  }
  rates_.resize(coordinates_.size());
}

double SmoothReversals::rate(int index) const {
  const Coordinate& coordinate = configuration_.model().coordinates[index];
  return rate_of(configuration_.coordinate_step(index, configuration_.increment_of(coordinate)));
}

void SmoothReversals::before_update() {
  for (std::size_t i = 0; i < coordinates_.size(); ++i) rates_[i] = rate(coordinates_[i]);
}

void SmoothReversals::after_update() {
  if (++updates_ > kMostStoppedUpdates) return;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& coordinate = configuration_.model().coordinates[coordinates_[i]];
    const double before = rates_[i], after = rate(coordinates_[i]);
    if (before * after >= 0 || std::max(std::abs(before), std::abs(after)) <= kFrictionSpeed) continue;
    const CoordinateStep step = configuration_.coordinate_step(coordinates_[i], 0);
    configuration_.released(coordinate.joint).displacement[coordinate.component] =
        step.begin + (1 - step.gamma) * step.step * step.begin_rate;
  }
}

bool SmoothReversals::turn_too_fast(double refinement) {
  if (coordinates_.empty()) return false;
  configuration_.find_begin_rates();
  return std::any_of(coordinates_.begin(), coordinates_.end(), [&](int index) {
    const Coordinate& coordinate = configuration_.model().coordinates[index];
    const double begin = configuration_.begin_rates(coordinate.joint)[coordinate.component];
    const double end = configuration_.end_rate(coordinate);
    return is_coarse_turn(begin, end, refinement);
  });
}

}  // namespace flexarm
