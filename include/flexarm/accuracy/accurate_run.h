#pragma once
/// Runs a simulation so that its error of time integration stays below a given bound, by choosing the steps.
/// (docs/notes/accuracy.md)

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/accuracy/trajectory.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// What run_to_accuracy() has to achieve, and how the error is measured.
struct AccuracyRequest {
  double accuracy;      ///< upper bound of motion_error(), in (0, 1)
  double until;         ///< end time of the run [s]
  int intervals = 100;  ///< number of equal intervals; positions are compared at their ends
  /// Length by which errors are divided [m]. Empty: length_of_errors().
  std::optional<double> scale = {};
  std::string frame = {};  ///< link in whose frame positions are compared, see JudgedPoints
  int most_tries = 24;
  double most_steps = 1e8;  ///< limit for the sum of the steps of all tries
  /// The same limit relative to the steps of the first try. Errors of second order are then a billionth of those of the
  /// first try.
  double most_refinement = 1e5;
};

/// Observes the tries of a run; each try begins at the same state.
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// Called when a try with that many steps begins. `estimate`: its expected error, NaN if unknown.
  virtual void begin(const Simulation&, long /*steps*/, double /*estimate*/) {}
  /// Called before each step; command efforts here.
  virtual void before_step(Simulation&) {}
  /// Called after each step. Return false to end the run.
  virtual bool after_step(const Simulation&, const StepResult&) { return true; }
  /// Called at the end of each interval. `estimate`: the estimated error at this time [m], NaN in the first try.
  virtual void after_interval(const Simulation&, double /*estimate*/) {}
};

/// The outcome of run_to_accuracy().
struct AccurateRun {
  enum class End {
    Met,            ///< the estimated error is within the requested accuracy
    Interrupted,    ///< RunWatcher::after_step() returned false
    Failed,         ///< a step failed, see `last`
    NoConvergence,  ///< shorter steps do not reduce the error, because of round-off or chaotic motion
    OutOfTries,
    OutOfSteps
  };
  struct Try {
    std::string scheme;
    long steps;
    double estimate;  ///< estimated motion_error(); NaN for the first try, or if no estimate is possible
  };

  End end = End::OutOfTries;
  double scale = 0;            ///< length by which errors are divided [m]
  int steps_per_interval = 0;  ///< of the last try, without steps added at events and at kinks of functions of time
  double interval = 0;         ///< length of an interval [s]
  std::vector<Try> tries;
  long steps = 0;       ///< sum of the steps of all tries
  StepResult last;      ///< outcome of the last step
  JudgedMotion motion;  ///< positions of the judged points in the last try

  /// Scheme of the last try; empty if there was none.
  std::string scheme() const { return tries.empty() ? "" : tries.back().scheme; }
  /// Estimated error of the last try; NaN if there was none.
  double estimate() const { return tries.empty() ? std::numeric_limits<double>::quiet_NaN() : tries.back().estimate; }
};

/// Repeats a run from the simulation's present state with more and more steps, until the estimated error is at most the
/// requested one. Afterwards the simulation is at the end of the last run. All steps have the same length, except
/// around events (Simulation::set_step_size). If the scheme of the scene is "auto", a try may use a scheme of higher
/// order if that promises less work; the simulation itself keeps its scheme. The watcher gets the simulation that is
/// running.
/// @throws std::invalid_argument if the request is out of range, a frame is unknown, or no division of the intervals
/// places the samples of servos at ends of steps.
AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher);

const char* to_string(AccurateRun::End end);
/// A message about a run that did not reach the requested `accuracy`. `more`: other relative errors to be mentioned.
std::string shortcoming(const AccurateRun& run, double accuracy, double more = 0);

}  // namespace flexarm
