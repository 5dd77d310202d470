#pragma once
/// Velocities and accelerations for output, made where somebody asks for them.

#include "simulation/output_velocities.h"
#include "simulation/past_motion.h"

namespace flexarm {

/// Keeps what was asked for until the state changes.
class PublishedMotion {
 public:
  void forget() { holds_rates_ = holds_velocities_ = holds_past_ = false; }
  bool holds_rates() const { return holds_rates_; }
  bool holds_velocities() const { return holds_velocities_; }
  bool holds_past() const { return holds_past_; }

  /// Those of coordinates alone.
  const OutputVelocities& rates(const MotionView& view) {
    if (!holds_rates_) velocities_.update_rates(view.model, view.dof, view.rule, view.state);
    holds_rates_ = true;
    return velocities_;
  }
  const OutputVelocities& velocities(const MotionView& view) {
    rates(view);
    if (!holds_velocities_) velocities_.update_nodes(view.model, view.dof, view.rule, view.state);
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
  bool holds_rates_ = false, holds_velocities_ = false, holds_past_ = false;
};

}  // namespace flexarm
