#pragma once
/// All joints of a model over a step: folds slaves into their masters (see TangentBackend), and applies efforts to
/// joint coordinates.

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

  /// Folds all joints from the leaves to the root, then mimic coordinates. The balance must contain the forces on all
  /// nodes.
  void evaluate(Balance& balance);
  /// Writes the joint coordinates into the state.
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
  std::vector<bool> is_resisted_;  // per joint: one of its coordinates has damping, a stop or friction
  FoldMaps fold_maps_;
  SlideMaps slide_maps_;
  std::vector<MimicMap> mimic_maps_;
};

}  // namespace flexarm
