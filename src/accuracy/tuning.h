#pragma once
/// Searches for the meshes, scheme, step and tolerance that are the cheapest for an accuracy, or the most accurate for
/// a speed.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// The goal of a search: one of the two numbers.
struct TuningGoal {
  std::optional<double> accuracy;  ///< motion_error(), relative to the largest displacement
  std::optional<double> load;      ///< largest processor time per simulated second [-]
};

struct TuningFreedom {
  bool all_meshes = true;   ///< false: only those of beams with elements="auto"
  bool any_scheme = false;  ///< false: only schemes that conserve what the scene's scheme conserves
  bool rigid_beams = true;  ///< beams may become rigid
};

/// A run of the search and its error.
struct TunedRun {
  RunSettings settings;
  double seconds = 0;  ///< processor time; a median if is_timed
  bool is_timed = false;
  long steps = 0, iterations = 0;
  std::size_t unknowns = 0;
  double energy_drift = 0;  ///< of an explicit scheme, see RunSummary
  double error = 0;         ///< relative to the largest displacement, against the reference; only of a complete run
  std::string failure;      ///< empty if the run is complete
};

struct TuningResult {
  std::vector<TunedRun> runs;            ///< all runs; first the scene as it stands, if it was run
  std::optional<std::size_t> best;       ///< index of the best run; if none meets the goal, of the most accurate
  std::optional<RunSettings> reference;  ///< empty: the search ended before it was made
  double reference_error = 0;            ///< estimated, relative
  double estimate = 0;                   ///< of the best run's error, from measured errors of meshes and steps
  double scale = 0;                      ///< largest displacement [m]
  bool is_met = false;                   ///< the best run meets the goal
  std::string shortcoming;               ///< why it does not, or why the search ended early; empty: all went well
  double seconds = 0;                    ///< processor time of all runs
};

/// Called with a description of the present stage, and with roughly the part of the search that is done.
using TuningProgress = std::function<void(double part, const std::string& what)>;

/// If the limits of runs or `go_on` of `trials` end the search, the result is the best so far.
TuningResult tune(TrialRuns& trials, const TuningGoal& goal, const TuningFreedom& freedom,
                  const TuningProgress& progress);

/// Names of the schemes that conserve at least what the scene's scheme does, which comes first. A scheme that
/// dissipates or is for study has no such others. If the scene leaves the choice to flexarm, explicit schemes follow,
/// which conserve nothing exactly. `any`: all schemes for common use.
std::vector<std::string> schemes_alike(const IntegratorDescription& integrator, bool any);

}  // namespace flexarm
