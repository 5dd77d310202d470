#pragma once
/// Measures the errors of a scheme with various steps: by runs with halved steps, and their extrapolated limit.

#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// Runs of one scheme on one mesh. From each run to the next, the step is halved.
struct StepErrors {
  RunSettings settings;                  ///< of the finest run
  std::vector<int> parts;                ///< steps in an interval, for each run
  std::vector<const TrialRun*> runs;     ///< incomplete runs come first
  std::vector<MotionDifference> errors;  ///< of each run; empty if it is incomplete
  bool is_met = false;                   ///< the finest error is small enough
  std::string shortcoming;               ///< why not

  bool has_errors() const { return !errors.empty() && errors.back().size() > 0; }
  /// Size of the error of the finest run [m].
  double finest() const;
  /// Error with `parts` steps in an interval, by the slope between the two nearest runs. Empty if it is coarser than
  /// all complete runs.
  MotionDifference at(int parts) const;
  /// Iterations per step, from the nearest run that is not finer.
  double iterations_per_step(int parts) const;
  /// Processor time of an iteration in all complete runs [s].
  double seconds_per_iteration() const;
};

/// Starts with one step in an interval, and halves it until the error is at most `wanted` times the largest
/// displacement. Round-off or the limits of `trials` may end it earlier. `most_seconds`: processor time of a run.
///
/// The errors follow from the differences d of successive runs. If these fall by a factor rho < 1 from one to the next,
/// the finest run is d rho / (1 - rho) from the limit. rho is measured, as soon as there are two differences. It is
/// believed only if it is at most 0.7: a scheme of first order has 0.5.
/// @throws SearchEnded
StepErrors measure_steps(TrialRuns& trials, RunSettings settings, double wanted, double most_seconds);

}  // namespace flexarm
