#pragma once
/// Runs of one scene with many settings. Each run is made once, within limits.

#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include <Eigen/Core>

#include "accuracy/run_settings.h"
#include "flexarm/accuracy/trajectory.h"

namespace flexarm {

/// Times at which motions are compared: multiples of an interval, from 0 on. Every step divides the interval.
struct JudgedTimes {
  double interval = 0;  ///< [s]
  int intervals = 0;

  double until() const { return interval * intervals; }
};

/// Divides the time `until` [s] into about `most` intervals or fewer, each a round multiple of the scene's `step` [s].
JudgedTimes judged_times(double until, double step, int most);

struct TrialRun {
  RunSettings settings;
  JudgedMotion motion;
  double mechanism = 0;  ///< size of the mechanism [m]
  double seconds = 0;    ///< processor time of all steps
  long steps = 0, iterations = 0;
  int halvings = 0;
  std::size_t unknowns = 0;
  double energy_drift = 0;   ///< of an explicit scheme, see RunSummary
  std::string failure;       ///< why it has not reached its end; empty if it has
  bool is_given_up = false;  ///< because it took too long

  bool is_complete() const { return failure.empty(); }
  bool is_at_rest() const { return flexarm::is_at_rest(motion, mechanism); }
  double length_of_errors() const { return flexarm::length_of_errors(motion, mechanism); }  ///< [m]
  /// Processor time per simulated second [-].
  double load(const JudgedTimes& times) const { return seconds / times.until(); }
};

/// Thrown if no further run may begin. The message is the reason.
class SearchEnded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A function that gives commands to a simulation before each of its steps.
using StepCommand = std::function<void(Simulation&)>;

struct TrialLimits {
  int runs = 500;
  double seconds = 600;  ///< processor time of all runs together
};

/// Makes runs and keeps them. References to runs stay valid.
class TrialRuns {
 public:
  /// `commands(simulation)` returns what commands the simulation; it may be empty. `go_on()` is called now and then; if
  /// it returns false, SearchEnded is thrown.
  TrialRuns(scene::SceneDescription scene, const JudgedTimes& times, const TrialLimits& limits,
            std::function<StepCommand(const Simulation&)> commands, std::function<bool()> go_on);

  /// Returns the run with these settings, which is made unless it exists already. A run is incomplete if the scene
  /// cannot be built with the settings, if a step fails, if it takes more than `most_seconds`, or if it is judged by
  /// other points than the first run. (Tips of beams are such points; if a beam is rigid, its tip may be fixed.)
  /// @throws SearchEnded if a limit is reached.
  const TrialRun& run(const RunSettings& settings, double most_seconds = std::numeric_limits<double>::infinity());
  /// Repeats a run to time it. Returns the processor time [s].
  double time_again(const RunSettings& settings);

  const std::deque<TrialRun>& all() const { return runs_; }
  const scene::SceneDescription& scene() const { return scene_; }
  const JudgedTimes& times() const { return times_; }
  double seconds() const { return seconds_; }  ///< processor time of all runs so far

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
  std::size_t judged_ = 0;  // number of judged points in the first run
};

// ---------------------------------------------------------------- differences of motions, which can be added

/// One column for each judged point, with its displacements at all times. They are weighted so that the norm of a
/// column is the root mean square of the distance [m].
using MotionDifference = Eigen::MatrixXd;

MotionDifference difference(const JudgedMotion& motion, const JudgedMotion& reference);
/// The norm of the worst point's column [m].
double size(const MotionDifference& difference);

}  // namespace flexarm
