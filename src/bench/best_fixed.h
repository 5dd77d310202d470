#pragma once
/// The cheapest run with fixed steps whose true error is small enough, where the true motion is known; and finer runs
/// with shifted steps, where it is not.

#include <functional>
#include <map>
#include <optional>

#include "accuracy/trial_runs.h"

namespace flexarm::bench {

/// What commands a simulation before each step; empty: nothing does.
using Commands = std::function<StepCommand(const Simulation&)>;

/// Runs of one scene with fixed steps, each made once, judged by its true motion. All solve the scene's own equations:
/// what depends on its step, as the stiffness of stops, is that of the scene.
class FixedRuns {
 public:
  struct Run {
    RunSettings settings;
    double seconds = 0;  ///< of the processor
    long iterations = 0;
    double error = 0;          ///< relative to the way of the true motion; infinite: it has not come to its end
    bool is_given_up = false;  ///< because it took too long
  };

  /// `seconds`: of the processor, for all runs of the search. `go_on()` is called before each.
  FixedRuns(const scene::SceneDescription& scene, const JudgedTimes& times, Commands commands, JudgedMotion truth,
            double seconds, std::function<void()> go_on);

  /// Of the schemes that conserve what the scene's does, with steps of 1, 1/2, 1/3, ... of the intervals and four
  /// tolerances of Newton's method, the run that takes least time of those whose error is at most `error`, and that of
  /// the next finer step, too: one that is good by luck is nobody's choice. Empty: none was found in the time that
  /// there is.
  const Run* best(double error);
  /// The same run once more: the processor's seconds.
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

/// The motion with these settings on a grid of steps that no run has which divides an interval equally: in each the
/// first step is 0.37, the last 0.63 of the others. Empty: servos are sampled, it takes more than `most_seconds` of the
/// processor, or a step fails.
std::optional<JudgedMotion> shifted_motion(const scene::SceneDescription& scene, const RunSettings& settings,
                                           const JudgedTimes& times, const Commands& commands, double most_seconds);

}  // namespace flexarm::bench
