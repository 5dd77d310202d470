#pragma once
/// Is the error as small as was asked for, and what does that cost?

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

struct AccuracyCase {
  std::string group, name;  ///< "speed", "demo_arm"
  scene::SceneDescription scene;
  std::string commands;  ///< file of efforts; empty: none
  double until;          ///< [s]
};

/// One scene run for one accuracy.
struct AccuracyOutcome {
  double asked = 0;
  bool is_met = false;      ///< says the run itself
  std::string shortcoming;  ///< why not
  double estimate = 0;      ///< of the run itself
  /// Against the reference, which is `reference_error` off itself; empty: there is none that is good enough.
  std::optional<double> error;
  double reference_error = 0;
  double seconds = 0;  ///< of the processor, of the run that has the accuracy: a median where there is a fixed choice
  double all_seconds = 0;  ///< with all tries before it
  long iterations = 0;     ///< of Newton's method, in that run
  /// The cheapest fixed choice whose error is as small as `error`, by search; empty: none was found.
  std::optional<double> fixed_seconds;
  long fixed_iterations = 0;
  std::string fixed;               ///< what that is
  bool is_of_own_scheme = false;   ///< that is of the scheme of the scene
  bool may_change_scheme = false;  ///< the scene leaves the scheme to the run

  bool is_judged() const { return is_met && error.has_value(); }
  /// Of the run over the best fixed choice.
  std::optional<double> cost() const;
};

struct AccuracyMeasurement {
  std::string group, name;
  double until = 0;
  std::vector<AccuracyOutcome> outcomes;
};

/// Which scenes are measured.
struct AccuracyScope {
  bool quick = false;                              ///< three scenes, one accuracy
  std::optional<std::pair<int, int>> random_arms;  ///< none but these: the first one, and how many
};

struct AccuracyReport {
  std::vector<AccuracyMeasurement> measurements;
  double seconds = 0;  ///< of the processor
  AccuracyScope scope;

  /// All outcomes that have a reference.
  std::vector<const AccuracyOutcome*> judged() const;
};

/// Scenes of the speed report, of config/ and random arms. `folder`: of configuration.
/// @throws std::runtime_error if one cannot be read.
std::vector<AccuracyCase> accuracy_cases(const std::string& folder, const AccuracyScope& scope);

/// `folder`: of configuration.
AccuracyReport measure_accuracy(const std::string& folder, const AccuracyScope& scope,
                                const std::function<void(double, const std::string&)>& progress);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const AccuracyReport& report, const std::string& picture);
/// Columns group, scene, until, asked, met, estimate, error, reference_error, seconds, all_seconds, iterations,
/// fixed_seconds, fixed_iterations, fixed, shortcoming.
std::string accuracy_to_csv(const AccuracyReport& report);

}  // namespace flexarm::bench
