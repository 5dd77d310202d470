#pragma once
/// A run that keeps a given error in time. (docs/notes/accuracy.md)

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

/// Observes the tries of a run; each try begins at the same state.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// A try of that many steps begins. `estimate`: its expected error, NaN if unknown.
  virtual void begin(const Simulation&, long /*steps*/, double /*estimate*/) {}
  /// Called before each step; command efforts here.
  virtual void before_step(Simulation&) {}
  /// Called after each step. Return false to end the run.
  virtual bool after_step(const Simulation&, const StepResult&) { return true; }
  /// An interval has ended. `estimate`: of the present error [m], NaN in the first try.
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

  /// Scheme of the last try; empty if there was none.
  std::string scheme() const { return tries.empty() ? "" : tries.back().scheme; }
  /// The estimate of the last try.
  double estimate() const { return tries.empty() ? std::numeric_limits<double>::quiet_NaN() : tries.back().estimate; }
};

/// Runs a simulation from its present state, again and again with more steps, until the estimated error is at most the
/// requested one. Then the simulation is at the end of that run. All steps are equal, except around events
/// (Simulation::set_step_size). If the scene leaves the scheme to flexarm ("auto"), a try may use another scheme of
/// higher order if that promises less work; the simulation itself keeps its scheme. A watcher sees the simulation that
/// runs.
/// @throws std::invalid_argument if the request is out of range, a frame is unknown, or the intervals cannot be divided
/// such that servos are sampled at ends of steps.
AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher);

const char* to_string(AccurateRun::End end);
/// A message about a run that did not keep the requested `accuracy`. `more`: other errors, relative.
std::string shortcoming(const AccurateRun& run, double accuracy, double more = 0);

}  // namespace flexarm
