#pragma once
/// Velocities and accelerations for output, made where somebody asks for them.

#include "simulation/output_velocities.h"
#include "simulation/past_motion.h"

namespace flexarm {

/// Keeps what was asked for until the state changes.
class PublishedMotion {
 public:
  void forget() { holds_velocities_ = holds_past_ = false; }

  const OutputVelocities& velocities(const MotionView& view) {
    if (!holds_velocities_) velocities_.update(view.model, view.dof, view.rule, view.state);
    holds_velocities_ = true;
    return velocities_;
  }
  const PastMotion& past(const MotionView& view) {
    if (!holds_past_) past_.update(view);
    holds_past_ = true;
    return past_;
  }

 private:
  OutputVelocities velocities_;
  PastMotion past_;
  bool holds_velocities_ = false, holds_past_ = false;
};

}  // namespace flexarm
