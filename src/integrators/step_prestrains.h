#pragma once
/// Prestrains of the beams over a step.

#include <limits>
#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// The strains of a step, those at its beginning too, are measured from one prestrain: its mean over the step where
/// forces are means over the step, else that of the instant at which the scheme evaluates forces, plus what makes up
/// for the rest of the step as in StepForce::acting. So elements see a constant, and their energy's change by it is
/// work (docs/notes/beam.md 3.6).
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
  /// Work at a stiffness point while its prestrain changes [J]: minus the elastic stress's, at the mean of both ends,
  /// plus what that of the step's forces is above the mean of both ends does on the strain's increment. `begin`, `end`:
  /// strains as measured in this step.
  template <int Nodes>
  double work(const BeamElement<Nodes>& element, int point, const Vector6& begin, const Vector6& end) const {
    const int i = element.prestrain + 1;
    const Vector6 elastic = begin + (0.5 / reach_) * (end - begin) + (of_step_[i] - mean_[i]);
    const auto& constants = element.stiffness_points[point];
    return constants.weight * ((end - begin).dot(constants.stiffness * surplus_[i]) / reach_ -
                               change_[i].dot(constants.stiffness * elastic));
  }

 private:
  /// By which the mean over a step is above that of the instants at which forces are taken, with the shares in which
  /// these make the step's impulse.
  Vector6 made_up(std::size_t i, double begin, double step) const;
  /// The same of the step before: the accelerations at both ends of a step share its impulse.
  void find_last_made_up();

  const StepConfiguration& configuration_;
  double reach_ = 1;  // where in the step strains at its "end" are
  bool do_work_ = false;
  // Per prestrain, after the zero of beams that have none.
  std::vector<Vector6> of_step_, mean_, change_, surplus_, made_up_, last_made_up_;
  // Ends and lengths of the steps to which the last two belong: a jump at the end of a step is on the same side for
  // both of its neighbours, which it need not be of a difference of times.
  double made_up_end_ = kNever, made_up_step_ = 0, last_end_ = kNever, last_step_ = 0;
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace flexarm
