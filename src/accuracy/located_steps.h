#pragma once
/// Steps that end where the equations change. (docs/notes/accuracy.md 4)

#include <vector>

#include "flexarm/accuracy/accurate_run.h"
#include "model/model.h"

namespace flexarm {

/// Times between `begin` and `end` [s], increasing, at which loads, efforts, set points or their rates jump, as the
/// scene and commands have them, or at which a servo takes a sample.
std::vector<double> known_corners(const Simulation& simulation, double begin, double end);

/// Takes a simulation through a time that is cut into cells, at whose ends something has to be: results, or a corner.
/// A cell has steps of equal length, but that steps also end at events, behind which the rest of the cell is divided
/// anew.
class LocatedSteps {
 public:
  /// `cells`: their ends, increasing, the first one where the simulation begins [s].
  LocatedSteps(Simulation& simulation, std::vector<double> cells);

  /// From now on the longest cell has `steps` steps, a shorter one fewer by the square root of its length: its local
  /// error is small. The tolerance of Newton's method is that of the longest steps. Starts with the first cell.
  void set(int steps, double tolerance);
  /// Steps of all cells, but for what events add, if the longest has `steps`.
  double planned(double steps) const;
  /// Length of the longest steps [s].
  double step() const { return longest_ / steps_; }
  /// Goes on to the end of the cell that ends at `time` [s]. What the last step came to; `iterations`, `recoveries` and
  /// steps of `run` are counted, those of steps that are taken back included. Not converged: a step has failed, or the
  /// watcher has had enough, which `run.end` tells.
  bool advance_to(double time, RunWatcher& watcher, AccurateRun& run);

  long iterations = 0;  ///< of Newton's method
  int recoveries = 0;   ///< other guesses, and halvings that no event has asked for

 private:
  double steps_of(double length, double steps) const;
  bool advance_through_cell(double end, RunWatcher& watcher, AccurateRun& run);
  StepResult located_step(double length, RunWatcher& watcher);
  StepResult step(double length, double tolerance, RunWatcher& watcher);

  Simulation& simulation_;
  std::vector<double> cells_;
  std::size_t next_ = 1;
  double longest_ = 0, tolerance_ = 0;
  int steps_ = 1;
  bool has_events_;
  Snapshot before_;  // the step
};

}  // namespace flexarm
