#pragma once
/// A run whose error in time is as small as is asked for. (docs/notes/accuracy.md)

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/accuracy/trajectory.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

struct AccuracyRequest {
  double accuracy;                   ///< motion_error() at most, in (0, 1)
  double until;                      ///< [s]
  int intervals = 100;               ///< of equal length, between times at which points are judged
  std::optional<double> scale = {};  ///< of errors [m]; none: points' way, 1e-6 of the size at least
  std::string frame = {};            ///< in which points are judged, see JudgedPoints
  int most_tries = 24;
  double most_steps = 1e8;  ///< of all tries
};

/// Looks at the tries of a run, each of which begins at the same state.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// A try of so many steps begins; `estimate`: what its error is expected to be, NaN: unknown.
  virtual void begin(const Simulation&, long /*steps*/, double /*estimate*/) {}
  /// Before each step: the place to command efforts.
  virtual void before_step(Simulation&) {}
  /// After each step. False: the run is to end.
  virtual bool after_step(const Simulation&, const StepResult&) { return true; }
  /// An interval has ended. `estimate`: of the error now [m], NaN in the first try.
  virtual void after_interval(const Simulation&, double /*estimate*/) {}
};

struct AccurateRun {
  enum class End {
    Met,
    Interrupted,
    Failed,         ///< a step has, see `last`
    NoConvergence,  ///< shorter steps make the error no smaller: round-off, or chaos
    OutOfTries,
    OutOfSteps
  };
  struct Try {
    std::string scheme;
    long steps;
    double estimate;  ///< of motion_error(); NaN: the first one, or it says nothing
  };

  End end = End::OutOfTries;
  double scale = 0;            ///< of errors [m]
  int steps_per_interval = 0;  ///< of the last try, but for those that end at corners
  double interval = 0;         ///< [s]
  std::vector<Try> tries;
  long steps = 0;   ///< of all tries
  StepResult last;  ///< of the last step
  JudgedMotion motion;

  /// Of the last try; empty: there was none.
  std::string scheme() const { return tries.empty() ? "" : tries.back().scheme; }
  /// The estimate of the last try.
  double estimate() const { return tries.empty() ? std::numeric_limits<double>::quiet_NaN() : tries.back().estimate; }
};

/// Runs a simulation from where it is, again and again from there with more steps, until the estimate of the error is
/// at most what is asked for; then the simulation is at the end of that run. All steps are equal, but around events
/// (Simulation::set_step_size). Where the scene leaves the scheme to flexarm ("auto"), tries may be made with another
/// one of higher order, if that promises less work; the simulation itself keeps its own. What a watcher is shown is the
/// one that runs.
/// @throws std::invalid_argument if the request is out of range, a frame is unknown, or the intervals cannot be divided
/// so that servos are sampled at ends of steps.
AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher);

const char* to_string(AccurateRun::End end);
/// What is to be said of a run that was asked for `accuracy` and has not met it. `more`: what else errs, relative.
std::string shortcoming(const AccurateRun& run, double accuracy, double more = 0);

}  // namespace flexarm
