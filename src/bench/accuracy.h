#pragma once
/// Measures whether runs to an accuracy (`flexarm simulate --accuracy`) meet it, and what they cost.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/outside_references.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

struct AccuracyCase {
  std::string group, name;  ///< "speed", "demo_arm"
  scene::SceneDescription scene;
  std::string commands;      ///< file of efforts; empty: none
  double until;              ///< [s]
  bool is_cornered = false;  ///< has jumps, kinks, stops, contact, dry friction, play or limits
  int intervals = 100;       ///< between the times at which the error is measured
  std::optional<JudgedMotion> truth =
      {};                  ///< true motion from elsewhere than flexarm; empty: finer runs are the reference
  double truth_error = 0;  ///< error of `truth`, relative
};

/// Outcome of one run of a scene to one accuracy.
struct AccuracyOutcome {
  double asked = 0;
  bool is_met = false;      ///< whether the run itself claims to meet the accuracy
  std::string shortcoming;  ///< why the accuracy was not met
  double estimate = 0;      ///< the run's own estimate of its error
  /// Error against the reference, which itself has the error `reference_error`; empty: no reference is good enough.
  std::optional<double> error;
  double reference_error = 0;
  double seconds = 0;  ///< processor time of the last try; the median of several runs if there is a best fixed choice
  double all_seconds = 0;  ///< including all tries before
  long iterations = 0;     ///< of Newton's method, in the last try
  /// Processor time of the cheapest fixed settings, found by search, whose error is as small as `error`; empty: none
  /// found.
  std::optional<double> fixed_seconds;
  long fixed_iterations = 0;
  std::string fixed;               ///< text of these fixed settings
  bool is_of_own_scheme = false;   ///< whether these settings have the scene's scheme
  bool may_change_scheme = false;  ///< whether the scene lets the run choose its scheme

  bool is_judged() const { return is_met && error.has_value(); }
  /// Processor time of the run relative to that of the best fixed settings; empty if there are none.
  std::optional<double> cost() const;
};

struct AccuracyMeasurement {
  std::string group, name;
  double until = 0;
  bool is_cornered = false,
       is_outside = false;  ///< whether the scene has corners; whether its reference comes from elsewhere than flexarm
  std::vector<AccuracyOutcome> outcomes;
};

/// The choice of scenes to measure.
struct AccuracyScope {
  bool quick = false;                              ///< three scenes, one accuracy
  std::optional<std::pair<int, int>> random_arms;  ///< only these random arms: the first one, and their number
  std::string only;                                ///< only scenes with this text in "GROUP: NAME"; empty: all
};

struct AccuracyReport {
  std::vector<AccuracyMeasurement> measurements;
  double seconds = 0;  ///< processor time
  AccuracyScope scope;

  /// All outcomes that have a reference, of runs that claim to meet the accuracy.
  std::vector<const AccuracyOutcome*> judged() const;
};

/// Scenes to measure: those of `references`, a folder written by scripts/outside_references (empty: none), of the speed
/// report, and of config/, and random arms. `folder`: the configuration folder.
/// @throws std::runtime_error if a file cannot be read
std::vector<AccuracyCase> accuracy_cases(const std::string& folder, const std::string& references,
                                         const AccuracyScope& scope);

AccuracyReport measure_accuracy(const std::vector<AccuracyCase>& cases, const AccuracyScope& scope,
                                const std::function<void(double, const std::string&)>& progress);

/// Three lines, for scenes with corners, for those of them with contact, and for smooth scenes: share of runs within
/// their accuracy, worst ratio, median cost.
std::string accuracy_summary(const AccuracyReport& report);

/// The tables. `picture`: file name of the plot in the same folder; empty: none.
std::string to_markdown(const AccuracyReport& report, const std::string& picture);
/// A CSV table with the columns group, scene, corners, reference, until, asked, met, estimate, error, reference_error,
/// seconds, all_seconds, iterations, fixed_seconds, fixed_iterations, fixed, shortcoming.
std::string accuracy_to_csv(const AccuracyReport& report);

}  // namespace flexarm::bench
