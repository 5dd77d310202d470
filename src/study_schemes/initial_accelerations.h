#pragma once
/// The accelerations from which Newmark's family starts, and starts anew after a kink.

#include <vector>

#include "integrators/acceleration_finder.h"
#include "integrators/stepper.h"

namespace flexarm {

/// Takes accelerations from short momentum-conserving steps: these need none themselves, and have the means of all
/// forces. Allocates no memory after its first step.
class InitialAccelerations : public AccelerationFinder {
 public:
  /// `of_step`: settings of the steps to come. The model must outlive this.
  InitialAccelerations(const Model& model, const StepSettings& of_step);

  StepResult find(State& state) override;
  void renew(State& state, double step) override;

 private:
  StepResult find(State& state, double step);
  /// Gives slaves of joints the velocities that follow from those of their masters and from the joints' rates.
  void put_on_joints(State& state);

  const Model& model_;
  double first_step_;  // [s]
  Stepper momentum_;
  State moved_;
  std::vector<NodePose> poses_;      // scratch
  std::vector<Vector6> velocities_;  // scratch
};

}  // namespace flexarm
