#pragma once
/// Runs of one scheme with more and more steps, and what their differences say about their errors.

#include <limits>
#include <vector>

#include "accuracy/located_steps.h"
#include "flexarm/accuracy/accurate_run.h"

namespace flexarm {

/// What the tries of a run have in common, whatever their scheme.
struct TryPlan {
  const AccuracyRequest& request;
  RunWatcher& watcher;
  JudgedPoints points;
  double begin;               ///< [s]
  std::vector<double> cells;  ///< ends of the cells of LocatedSteps: judged times, and corners that are known [s]

  double interval() const { return (request.until - begin) / request.intervals; }  ///< [s]
  double judged_time(int i) const { return i == request.intervals ? request.until : begin + i * interval(); }
};

class SchemeTries {
 public:
  /// From where the simulation is.
  SchemeTries(Simulation& simulation, const TryPlan& plan);

  Simulation& simulation() const { return simulation_; }
  /// The same, back where the tries begin.
  Simulation& at_start() {
    simulation_.restore(start_);
    return simulation_;
  }
  /// What the next try has, in all.
  double next_steps() const { return stepping_.planned(next_); }
  double fewest_steps() const { return stepping_.planned(1); }
  double estimate() const { return estimate_; }  ///< of the last try that was judged, relative; NaN: there is none
  /// Of the last try that was judged.
  double iterations() const { return iterations_before_; }
  double iterations_per_step() const { return iterations_before_ / planned_before_; }
  /// Iterations of a try that has the error which is asked for; NaN: unknown.
  double predicted_iterations() const;
  int judged() const { return judged_; }

  /// What the last two tries that were judged tend to, without the leading term of their errors.
  const JudgedMotion& limit() const { return limit_; }
  /// Whether that may be so near the true motion that a try of another scheme can be judged by it: its error is the
  /// square of a phase error at least.
  bool limit_may_judge() const;
  /// What the tries of another scheme tend to, by which the first one of these is judged; it must outlive them.
  void judge_first_by(const JudgedMotion& limit) { other_limit_ = &limit; }

  /// Makes the next try. False if a step has failed, or the run was interrupted, which `run.end` tells.
  bool attempt(AccurateRun& run);
  /// Estimates the error of that try from its difference to the one before, or to the other scheme's limit, unless it
  /// is astray. True if nothing more is to be tried: `run.end` tells why.
  bool judge(AccurateRun& run);
  /// The next try has more steps. `failed`: the last one was not judged. False if too many have failed in turn.
  bool go_on(bool failed);

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  void set_steps();
  /// Steps had to be saved, and Newton's method has more to do than in the longer ones of the try before: whatever is
  /// solved there, it is not where the error has an expansion in the step.
  bool is_astray() const {
    const double iterations = static_cast<double>(stepping_.iterations);
    return stepping_.recoveries > 0 && iterations / planned_ > iterations_per_step();
  }
  /// By another try whose steps are not nested in those of the last one: only the first two are so. Of the first one by
  /// the limit of another scheme.
  bool is_confirmed() const { return judged_ > 2 || (judged_ == 1 && other_limit_); }
  /// To what the next try is compared, and the part of the difference that is its error; null: to nothing.
  const JudgedMotion* compared() const { return judged_ > 0 ? &before_ : other_limit_; }
  double compared_share() const { return judged_ > 0 ? share(order_, planned_before_) : 1; }
  double supposed_order(double difference) const;
  double share(double order, double planned) const;
  double estimate_of(const JudgedMotion& motion, double scale);

  Simulation& simulation_;
  const TryPlan& plan_;
  Snapshot start_;
  int order_, solves_;  // of a step
  LocatedSteps stepping_;
  int steps_ = 0, next_ = 1;  // in the longest cell, of the last and the next try
  double planned_ = 0;        // steps of the last try
  double expected_ = kUnknown;
  int failures_ = 0, stagnations_ = 0, unsettled_ = 0, judged_ = 0;
  const JudgedMotion* other_limit_ = nullptr;
  JudgedMotion limit_;
  // Of the last try that was judged, and of the one before that.
  JudgedMotion before_, earlier_;
  double planned_before_ = kUnknown, planned_earlier_ = kUnknown;
  double estimate_ = kUnknown, difference_ = kUnknown, iterations_before_ = kUnknown;
};

}  // namespace flexarm
