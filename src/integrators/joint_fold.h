#pragma once
/// All joints of a model over a step: slaves are folded into their masters, efforts act on what is released.

#include <vector>

#include "integrators/actuators.h"
#include "integrators/balance.h"
#include "integrators/dry_friction_step.h"
#include "integrators/held_efforts.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"

namespace flexarm {

class JointFold {
 public:
  JointFold(const StepConfiguration& configuration, const StepHistories& histories, DryFrictionStep& friction,
            const Actuators& actuators);

  /// Folds all joints from leaf to root, then coordinates that follow others; all nodes' forces are in the balance.
  void evaluate(Balance& balance);
  /// Adds the work of efforts over the step to `work` [J].
  void add_work(double& work) const;
  /// Finds what drove prescribed coordinates; before add_work().
  void find_drives(const ReducedResidual& residual, HeldEfforts& held, StepMeans& drives);
  /// Writes released coordinates and efforts.
  void accept(State& state) const;
  /// Per coordinate: effort in this step.
  const std::vector<double>& efforts() const { return applied_; }

 private:
  /// Where efforts are those at ends: the mean over the step, for work.
  double effort_of_step(std::size_t coordinate) const;
  Vector6 force_on_slave(int joint, const Balance& balance) const;
  template <class Maps>
  void fold(int joint, Maps& maps, Balance& balance);
  void add_efforts(int joint, Balance& balance);
  void add_resistance(int joint, Balance& balance);

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  DryFrictionStep& friction_;
  const Actuators& actuators_;
  std::vector<StopPenalty> stops_;  // per coordinate
  std::vector<bool> is_resisted_;   // per joint: damping, a stop or friction acts on a coordinate of it
  std::vector<double> applied_;
  FoldMaps fold_maps_;
  SlideMaps slide_maps_;
  std::vector<MimicMap> mimic_maps_;
};

}  // namespace flexarm
