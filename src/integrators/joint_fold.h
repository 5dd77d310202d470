#pragma once
/// All joints of a model over a step: slaves are folded into their masters, and efforts act on released coordinates.

#include <vector>

#include "integrators/actuators.h"
#include "integrators/balance.h"
#include "integrators/dry_friction_step.h"
#include "integrators/joint_efforts.h"
#include "integrators/step_configuration.h"

namespace flexarm {

class JointFold {
 public:
  JointFold(const StepConfiguration& configuration, const JointEfforts& efforts, DryFrictionStep& friction,
            const Actuators& actuators);

  /// Folds all joints from leaf to root, then coordinates that follow others; all nodes' forces are in the balance.
  void evaluate(Balance& balance);
  /// Writes released coordinates.
  void accept(State& state) const;

 private:
  Vector6 force_on_slave(int joint, const Balance& balance) const;
  template <class Maps>
  void fold(int joint, Maps& maps, Balance& balance);
  void add_efforts(int joint, Balance& balance);
  void add_resistance(int joint, Balance& balance);

  const StepConfiguration& configuration_;
  const JointEfforts& efforts_;
  DryFrictionStep& friction_;
  const Actuators& actuators_;
  std::vector<StopPenalty> stops_;  // per coordinate
  std::vector<bool> is_resisted_;   // per joint: damping, a stop or friction acts on a coordinate of it
  FoldMaps fold_maps_;
  SlideMaps slide_maps_;
  std::vector<MimicMap> mimic_maps_;
};

}  // namespace flexarm
