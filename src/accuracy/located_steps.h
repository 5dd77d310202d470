#pragma once
/// Makes steps that end where the equations of motion change. (docs/notes/accuracy.md 4)

#include <vector>

#include "flexarm/accuracy/accurate_run.h"
#include "model/model.h"

namespace flexarm {

/// Increasing times between `begin` and `end` [s] at which equations change, as far as scene and commands foresee it:
/// loads, efforts, set points or their rates jump, or a servo takes a sample.
std::vector<double> known_corners(const Simulation& simulation, double begin, double end);

/// Takes a simulation through a time that is cut into cells. At the end of a cell there is a corner, or results are
/// needed. The steps of a cell have equal lengths. Beside jumps that strike, such as those of a set point that a
/// servo's derivative follows, there are short cells. Steps also end at events, after which the rest of the cell is
/// divided anew. During hits, steps are shorter by a power of two, the same in all tries.
class LocatedSteps {
 public:
  /// `cells`: ends of the cells, increasing. The first number is the time at which the simulation begins [s].
  LocatedSteps(Simulation& simulation, const std::vector<double>& cells);

  /// Returns to this state of the simulation, which was taken before the first steps.
  void go_back(const Snapshot& start);
  /// Starts again with the first cell. The longest cell gets `steps` steps. Shorter ones get fewer, by the square root
  /// of their length, since their local errors are small. `tolerance` of Newton's method is for the longest steps. If
  /// these are shorter than the scene's step, the scheme gets their constants, whose effect falls with the errors.
  void set(int steps, double tolerance);
  /// Number of steps in all cells if the longest has `steps`, without those that events add.
  double planned(double steps) const;
  /// Length of the longest steps [s].
  double step() const { return longest_ / steps_; }
  /// Advances to the end of the cell that ends at `time` [s]. Counts `iterations` and `recoveries`, with those of
  /// repeated steps, `turn`, and the steps of `run`, and sets `run.last`. Returns false if a step has failed or the
  /// watcher ends the run; `run.end` says which.
  bool advance_to(double time, RunWatcher& watcher, AccurateRun& run);

  long iterations = 0;  ///< of Newton's method
  int recoveries = 0;   ///< other guesses, and halvings unless events may cause them
  double turn = 0;      ///< largest rotation of a node in a sub-step [rad]
  /// Whether bodies have touched each other, or a stop has struck a mechanism with beams: it starts waves that few
  /// steps resolve, so that differences of tries do not show the order of the scheme.
  bool had_contacts = false;

 private:
  /// Not within a hit.
  static constexpr int kNoHit = -1;

  double steps_of(double length, double steps) const;
  /// Length of the next step if the rest of the cell and its longest steps have these lengths.
  double next_length(double rest, double longest) const;
  /// Length of the longest steps, in a hit of those in it [s].
  double step_now() const;
  void follow_hit();
  /// Whether bodies touch each other; or that, or coordinates their stops.
  bool is_in_contact() const;
  bool is_in_hit() const;
  bool advance_through_cell(double end, RunWatcher& watcher, AccurateRun& run);
  StepResult located_step(double length, RunWatcher& watcher);
  StepResult step(double length, double tolerance, RunWatcher& watcher);

  Simulation& simulation_;
  std::vector<double> cells_;
  std::size_t next_ = 1;
  double longest_ = 0, tolerance_ = 0;
  double step_of_scene_;  // from which the scheme had its constants at the beginning [s]
  int steps_ = 1;
  int level_ = kNoHit;  // in a hit, steps have the length step() / 2^level_
  int good_steps_ = 0;  // since the level has changed
  int events_ = 0;      // in this cell so far
  bool has_events_, has_hits_, bends_ = false, is_at_event_ = false;
  bool is_new_hit_ = false;  // no step of this hit has shown the level yet
  Snapshot before_;          // state before the step
};

}  // namespace flexarm
