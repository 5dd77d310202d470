#pragma once
/// Finds the cheapest run with fixed steps whose true error is small enough, for scenes whose true motion is known; and
/// makes finer runs with shifted steps, for scenes whose true motion is not known.

#include <functional>
#include <map>
#include <optional>

#include "accuracy/trial_runs.h"

namespace flexarm::bench {

/// Makes the function that commands a simulation before each step; empty: no commands.
using Commands = std::function<StepCommand(const Simulation&)>;

/// Runs of one scene with fixed steps. Each is made once, and compared with the true motion. All runs solve the same
/// equations: quantities that depend on the scene's step, such as the stiffness of stops, are those of the scene's own
/// step.
class FixedRuns {
 public:
  struct Run {
    RunSettings settings;
    double seconds = 0;  ///< processor time
    long iterations = 0;
    double error =
        0;  ///< relative to the largest displacement of the true motion; infinite: the run did not reach its end
    bool is_given_up = false;  ///< whether the run was stopped because it took too long
  };

  /// @param seconds  processor time for all runs of the search
  /// @param go_on    called before each run
  FixedRuns(const scene::SceneDescription& scene, const JudgedTimes& times, Commands commands, JudgedMotion truth,
            double seconds, std::function<void()> go_on);

  /// The fastest run whose error is at most `error`. Schemes that conserve the same as the scene's are tried, with
  /// steps of 1, 1/2, 1/3, ... of an interval, and four tolerances of Newton's method. The run with the next smaller
  /// step must meet `error`, too, so that no run counts that is good only by chance. Null: none was found within the
  /// time limit.
  const Run* best(double error);
  /// Processor time of the same run, made once more.
  double time_again(const Run& run) const { return made(run.settings, 1e9).seconds; }

 private:
  const Run& run(const RunSettings& settings, double most_seconds);
  Run made(const RunSettings& settings, double most_seconds) const;

  const scene::SceneDescription& scene_;
  JudgedTimes times_;
  Commands commands_;
  JudgedMotion truth_;
  double seconds_;
  std::function<void()> go_on_;
  std::map<RunSettings, Run> runs_;
};

/// The motion with these settings, but with steps that no other run has and that still divide an interval: in each
/// interval, the first step has 0.37 and the last one 0.63 times the usual length. Empty if servos are sampled, if the
/// run takes more than `most_seconds` of processor time, or if a step fails.
std::optional<JudgedMotion> shifted_motion(const scene::SceneDescription& scene, const RunSettings& settings,
                                           const JudgedTimes& times, const Commands& commands, double most_seconds);

}  // namespace flexarm::bench
