#pragma once
/// Prestrains of beams that vary in time, over a step.

#include <limits>
#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// All strains of a step, including those at its beginning, are measured from one prestrain. If forces are means over
/// the step, it is the mean of the prestrain. Otherwise it is the value at the instant at which the scheme evaluates
/// forces, plus a correction for the rest of the step as in StepForce::acting. So prestrains are constant for elements,
/// and their change from step to step does work (docs/notes/beam.md 3.6).
class StepPrestrains {
 public:
  explicit StepPrestrains(const StepConfiguration& configuration);

  /// To be called when the configuration has begun its step. `factor`: of loads in statics. Returns whether prestrains
  /// differ from those of the last step, so that strains kept from it are invalid.
  bool begin(double factor);
  /// {Gamma, K} at the mass centroid, from which strains of this step are measured. `prestrain`:
  /// BeamElement::prestrain.
  const Vector6& of_step(int prestrain) const { return of_step_[prestrain + 1]; }
  /// Whether a prestrain changes over the step.
  bool do_work() const { return do_work_; }
  /// Work of a changing prestrain at a stiffness point [J]. It has two terms: minus the work of the elastic stress, at
  /// the mean of both ends, on the change of the prestrain; and the work of the surplus of the step's stress over this
  /// mean, on the strain's increment. `begin`, `end`: strains as measured in this step.
  template <int Nodes>
  double work(const BeamElement<Nodes>& element, int point, const Vector6& begin, const Vector6& end) const {
    const int i = element.prestrain + 1;
    const Vector6 elastic = begin + (0.5 / reach_) * (end - begin) + (of_step_[i] - mean_[i]);
    const auto& constants = element.stiffness_points[point];
    return constants.weight * ((end - begin).dot(constants.stiffness * surplus_[i]) / reach_ -
                               change_[i].dot(constants.stiffness * elastic));
  }

 private:
  /// The mean over a step minus the weighted mean of the values at the instants at which forces are evaluated.
  Vector6 made_up(std::size_t i, double begin, double step) const;
  /// Finds the same for the step before, since the accelerations at both ends of a step share its impulse.
  void find_last_made_up();

  const StepConfiguration& configuration_;
  double reach_ = 1;  // fraction of the step at which the strains of its "end" are
  bool do_work_ = false;
  // Per prestrain. Index 0 is a zero prestrain, for beams without one.
  std::vector<Vector6> of_step_, mean_, change_, surplus_, made_up_, last_made_up_;
  // Ends and lengths of the steps that made_up_ and last_made_up_ belong to. A jump of the prestrain at the end of a
  // step must be seen on the same side by both neighbouring steps; recomputed times might put it on different sides.
  double made_up_end_ = kNever, made_up_step_ = 0, last_end_ = kNever, last_step_ = 0;
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace flexarm
