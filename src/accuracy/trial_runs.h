#pragma once
/// Runs of one scene with many settings, each made once, within bounds.

#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include <Eigen/Core>

#include "accuracy/run_settings.h"
#include "flexarm/accuracy/trajectory.h"

namespace flexarm {

/// Times at which motions are compared: multiples of an interval from 0 on, which every step divides.
struct JudgedTimes {
  double interval = 0;  ///< [s]
  int intervals = 0;

  double until() const { return interval * intervals; }
};

/// At most some `most` intervals to the time `until` [s], each a round multiple of the scene's `step` [s].
JudgedTimes judged_times(double until, double step, int most);

struct TrialRun {
  RunSettings settings;
  JudgedMotion motion;
  double seconds = 0;  ///< of the processor, for all steps
  long steps = 0, iterations = 0;
  int halvings = 0;
  std::size_t unknowns = 0;
  std::string failure;       ///< why it has not come to its end; empty: it has
  bool is_given_up = false;  ///< because it took too long

  bool is_complete() const { return failure.empty(); }
  /// Of the processor for a simulated second [-].
  double load(const JudgedTimes& times) const { return seconds / times.until(); }
};

/// No further run may begin: the reason.
class SearchEnded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What commands a simulation before each of its steps.
using StepCommand = std::function<void(Simulation&)>;

struct TrialLimits {
  int runs = 500;
  double seconds = 600;  ///< of the processor, for all runs together
};

/// Remembers all runs; references to them stay good.
class TrialRuns {
 public:
  /// `commands(simulation)`: what commands it; may be empty. `go_on()` is asked now and then; false: SearchEnded.
  TrialRuns(scene::SceneDescription scene, const JudgedTimes& times, const TrialLimits& limits,
            std::function<StepCommand(const Simulation&)> commands, std::function<bool()> go_on);

  /// A run with these settings, made now unless it has been made already. A scene that cannot be built with them, a
  /// step that fails, a run that takes more than `most_seconds` and one that is judged by other points than the first
  /// one (tips of beams that cannot move where they are rigid) are runs that are not complete.
  /// @throws SearchEnded where a limit is reached.
  const TrialRun& run(const RunSettings& settings, double most_seconds = std::numeric_limits<double>::infinity());
  /// The same once more, for its time alone: the processor's seconds.
  double time_again(const RunSettings& settings);

  const std::deque<TrialRun>& all() const { return runs_; }
  const scene::SceneDescription& scene() const { return scene_; }
  const JudgedTimes& times() const { return times_; }
  double seconds() const { return seconds_; }  ///< of the processor, of all runs so far

 private:
  TrialRun made(const RunSettings& settings, double most_seconds);
  void step_through(Simulation& simulation, TrialRun& run, double most_seconds);
  void require_room() const;

  scene::SceneDescription scene_;
  JudgedTimes times_;
  TrialLimits limits_;
  std::function<StepCommand(const Simulation&)> commands_;
  std::function<bool()> go_on_;
  std::deque<TrialRun> runs_;
  std::map<RunSettings, TrialRun*> known_;
  double seconds_ = 0;
  int repetitions_ = 0;
  std::size_t judged_ = 0;  // points, of the first run
};

// ---------------------------------------------------------------- differences of motions, which add up

/// A column for each judged point, of its ways at all times, weighted so that the norm of a column is the root mean
/// square of the distance [m].
using MotionDifference = Eigen::MatrixXd;

MotionDifference difference(const JudgedMotion& motion, const JudgedMotion& reference);
/// Whether points come farther than round-off of where they are.
bool moves(const JudgedMotion& motion);
/// Of the worst point [m].
double size(const MotionDifference& difference);

}  // namespace flexarm
