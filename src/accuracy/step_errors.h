#pragma once
/// What errors does a scheme make with which steps? Runs with halved steps, and their limit by extrapolation.

#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// Runs of one scheme on one mesh, the step halved from each to the next.
struct StepErrors {
  RunSettings settings;                  ///< of the finest
  std::vector<int> parts;                ///< of an interval, one for each step: how many
  std::vector<const TrialRun*> runs;     ///< as many; those that are not complete come first
  std::vector<MotionDifference> errors;  ///< as many; empty where a run is not complete
  bool is_met = false;                   ///< the finest error is small enough
  std::string shortcoming;               ///< why not

  bool has_errors() const { return !errors.empty() && errors.back().size() > 0; }
  /// Of the finest run [m].
  double finest() const;
  /// Between and beyond the runs by the slope between the nearest two. Empty: coarser than all complete runs.
  MotionDifference at(int parts) const;
  /// Iterations per step, those of the nearest run that is not finer.
  double iterations_per_step(int parts) const;
};

/// Halves the step from an interval on until the error is at most `wanted` times the largest displacement, or round-off
/// or the runs' limits end it. `most_seconds`: of a run.
///
/// The errors follow from differences d of successive runs: as they fall by a factor rho < 1 from one to the next, the
/// finest run is d rho / (1 - rho) from the limit. rho is measured; it counts from two differences on, and only where
/// it is at most 0.7: a scheme of first order has 0.5.
/// @throws SearchEnded
StepErrors measure_steps(TrialRuns& trials, RunSettings settings, double wanted, double most_seconds);

}  // namespace flexarm
