#pragma once
/// Accelerations of points, from where they were after the last steps (theory.md, "Published velocities and efforts").

#include <array>

#include "flexarm/model/results.h"
#include "simulation/motion_view.h"

namespace flexarm {

/// Mean rates of a vector over the last steps, newest first, and how long these were.
struct MeanRates {
  static constexpr int kMost = 4;
  int count = 0;
  std::array<Vector3, kMost> rate;
  std::array<double, kMost> length;  ///< [s]; parts of a composed step may be negative

  /// The rate's own rate at the end of the newest step: of second order where the motion is smooth over four steps, and
  /// without what alternates from step to step. Zero where fewer than two steps are known. Invariant under rotations.
  Vector3 change_at_end() const;
};

/// The configurations after the last steps. They follow from the increments that the state remembers for the
/// predictor: nothing else is kept. Allocates only for another model than before.
class PastMotion {
 public:
  void update(const MotionView& view);
  ProbeAcceleration acceleration(const MotionView& view, const ProbePoint& point) const;

 private:
  void go_back(const MotionView& view, int step, double begin);

  int count_ = 0;
  std::array<double, MeanRates::kMost> length_{};
  State earlier_;                                       // nodes and released coordinates only
  std::vector<NodePose> poses_;                         // of earlier_
  std::array<State, MeanRates::kMost> configurations_;  // nodes only: at the beginnings of the steps, newest first
};

}  // namespace flexarm
