#pragma once
/// Prestrains of the beams over a step.

#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// The strains of a step, those at its beginning too, are measured from one prestrain: its mean over the step where
/// forces are means over the step, else that of the instant at which the scheme evaluates forces. So elements see a
/// constant, and their energy's change by it is work (docs/notes/beam.md 3.6).
class StepPrestrains {
 public:
  explicit StepPrestrains(const StepConfiguration& configuration);

  /// The configuration's step has begun. `factor`: of loads in statics. True if the prestrains are other ones than
  /// those of the last step: strains that were kept do not hold.
  bool begin(double factor);
  /// {Gamma, K} about the mass centroid that strains of this step are measured from; of BeamElement::prestrain.
  const Vector6& of_step(int prestrain) const { return of_step_[prestrain + 1]; }
  /// True if one of them changes over the step.
  bool do_work() const { return do_work_; }
  /// Work at a stiffness point while its prestrain changes: minus the elastic stress's, at the mean of both ends, plus
  /// what the mean prestrain of the step is above that of its ends does on the strain's increment [J]. `begin`, `end`:
  /// strains as measured in this step.
  template <int Nodes>
  double work(const BeamElement<Nodes>& element, int point, const Vector6& begin, const Vector6& end) const {
    const int i = element.prestrain + 1;
    const Vector6 elastic = begin + (0.5 / reach_) * (end - begin) + (of_step_[i] - mean_[i]);
    const auto& constants = element.stiffness_points[point];
    return constants.weight *
           ((end - begin).dot(constants.stiffness * surplus_[i]) - change_[i].dot(constants.stiffness * elastic));
  }

 private:
  const StepConfiguration& configuration_;
  double reach_ = 1;  // where in the step strains at its "end" are
  bool do_work_ = false;
  // Per prestrain, after the zero of beams that have none.
  std::vector<Vector6> of_step_, mean_, change_, surplus_;
};

}  // namespace flexarm
