#pragma once
/// Is the error as small as was asked for, and what does that cost?

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
  std::string commands;                    ///< file of efforts; empty: none
  double until;                            ///< [s]
  bool is_cornered = false;                ///< jumps, kinks, stops, dry friction, play, limits
  int intervals = 100;                     ///< between the times at which it is judged
  std::optional<JudgedMotion> truth = {};  ///< of somebody else than flexarm; empty: finer runs judge
  double truth_error = 0;                  ///< of that, relative
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
  bool is_cornered = false, is_outside = false;  ///< of the scene; its reference is not flexarm's
  std::vector<AccuracyOutcome> outcomes;
};

/// Which scenes are measured.
struct AccuracyScope {
  bool quick = false;                              ///< three scenes, one accuracy
  std::optional<std::pair<int, int>> random_arms;  ///< none but these: the first one, and how many
  std::string only;                                ///< scenes with this in "GROUP: NAME"; empty: all
};

struct AccuracyReport {
  std::vector<AccuracyMeasurement> measurements;
  double seconds = 0;  ///< of the processor
  AccuracyScope scope;

  /// All outcomes that have a reference.
  std::vector<const AccuracyOutcome*> judged() const;
};

/// Those of `references`, a folder that scripts/outside_references has written (empty: none), scenes of the speed
/// report, of config/ and random arms. `folder`: of configuration.
/// @throws std::runtime_error if one cannot be read.
std::vector<AccuracyCase> accuracy_cases(const std::string& folder, const std::string& references,
                                         const AccuracyScope& scope);

AccuracyReport measure_accuracy(const std::vector<AccuracyCase>& cases, const AccuracyScope& scope,
                                const std::function<void(double, const std::string&)>& progress);

/// Two lines, of smooth scenes and of those with corners: share of runs that keep their word, worst ratio, median cost.
std::string accuracy_summary(const AccuracyReport& report);

/// The tables. `picture`: file name of the picture next to them; empty if there is none.
std::string to_markdown(const AccuracyReport& report, const std::string& picture);
/// Columns group, scene, corners, reference, until, asked, met, estimate, error, reference_error, seconds, all_seconds,
/// iterations, fixed_seconds, fixed_iterations, fixed, shortcoming.
std::string accuracy_to_csv(const AccuracyReport& report);

}  // namespace flexarm::bench
