#pragma once
/// Which meshes, scheme, step and tolerance are the cheapest for an accuracy, or the most accurate for a speed?

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/trial_runs.h"

namespace flexarm {

/// What is asked for: one of both.
struct TuningGoal {
  std::optional<double> accuracy;  ///< motion_error(), relative to the largest displacement
  std::optional<double> load;      ///< most time of the processor for a simulated second [-]
};

struct TuningFreedom {
  bool all_meshes = true;   ///< else only of beams that ask for elements="auto"
  bool any_scheme = false;  ///< else only such as conserve what the scene's scheme conserves
  bool rigid_beams = true;  ///< beams may become rigid
};

/// A run of the search and its error.
struct TunedRun {
  RunSettings settings;
  double seconds = 0;  ///< of the processor; a median where is_timed
  bool is_timed = false;
  long steps = 0, iterations = 0;
  std::size_t unknowns = 0;
  double error = 0;     ///< of a run that came to its end, against the reference, relative to the largest displacement
  std::string failure;  ///< empty: it came to its end
};

struct TuningResult {
  std::vector<TunedRun> runs;            ///< all; the scene as it stands first, where it has been run
  std::optional<std::size_t> best;       ///< of them; the most accurate where none keeps what was asked for
  std::optional<RunSettings> reference;  ///< empty: ended before it was made
  double reference_error = 0;            ///< as estimated, relative
  double estimate = 0;                   ///< of the best run's error, before the reference was made
  double scale = 0;                      ///< largest displacement [m]
  bool is_met = false;                   ///< the best run keeps what was asked for
  std::string shortcoming;  ///< why it does not, or why the search ended before its end; empty: all went well
  double seconds = 0;       ///< of the processor, of all runs
};

/// Called with what is being done, and the part done, roughly.
using TuningProgress = std::function<void(double part, const std::string& what)>;

/// Ends with the best so far where the runs' limits or `go_on` of `trials` end it.
TuningResult tune(TrialRuns& trials, const TuningGoal& goal, const TuningFreedom& freedom,
                  const TuningProgress& progress);

/// Names of the schemes that conserve and dissipate at least what the scene's own does, this one first.
std::vector<std::string> schemes_alike(const IntegratorDescription& integrator, bool any);

}  // namespace flexarm
