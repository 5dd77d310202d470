#pragma once
/// Tries of one scheme with more and more steps, whose differences give estimates of their errors.

#include <limits>
#include <vector>

#include "accuracy/located_steps.h"
#include "flexarm/accuracy/accurate_run.h"
#include "schemes/scheme.h"

namespace flexarm {

/// What the tries of a run have in common, whatever their scheme.
struct TryPlan {
  const AccuracyRequest& request;
  RunWatcher& watcher;
  JudgedPoints points;
  double begin;               ///< [s]
  std::vector<double> cells;  ///< ends of the cells of LocatedSteps: judged times and known corners [s]

  double interval() const { return (request.until - begin) / request.intervals; }  ///< [s]
  double judged_time(int i) const {
    return i == request.intervals ? request.until : begin + (request.until - begin) * i / request.intervals;
  }
};

/// Cost of what StepResult counts as an iteration, relative to an iteration of Newton's method. For an explicit scheme
/// it is a step.
double cost_of_iteration(const Scheme& scheme);

class SchemeTries {
 public:
  /// Tries begin at the present state of the simulation.
  SchemeTries(Simulation& simulation, const TryPlan& plan);

  Simulation& simulation() const { return simulation_; }
  /// The simulation, in the state at which the tries begin.
  Simulation& at_start() {
    simulation_.restore(start_);
    return simulation_;
  }
  /// Total number of steps of the next try, and of the smallest possible one.
  double next_steps() const { return stepping_.planned(next_); }
  double fewest_steps() const { return stepping_.planned(1); }
  double estimate() const { return estimate_; }  ///< of the last judged try, relative; NaN: there is none
  /// Iterations of the last judged try.
  double iterations() const { return iterations_before_; }
  double iterations_per_step() const { return iterations_before_ / planned_before_; }
  /// Predicted cost of a try with the requested error, in iterations of Newton's method or what takes as long. NaN:
  /// unknown.
  double predicted_cost() const;
  /// Cost of the last judged try, of a step of the next one, and of all tries so far.
  double last_cost() const { return iterations_before_ * cost_of_iteration(scheme_); }
  double cost_per_step() const;
  double spent() const { return spent_; }
  int judged() const { return judged_; }
  /// Whether the error is known: from here on it is expected to fall with the order of the scheme.
  bool is_known() const;
  /// Whether an error of this size may be round-off.
  bool is_small(double estimate) const;

  /// Extrapolation of the last two judged tries, without the leading term of their errors.
  const JudgedMotion& limit() const { return limit_; }
  /// Whether the limit may be near enough to the true motion to judge a try of another scheme. Its error is at least
  /// the square of a phase error.
  bool limit_may_judge() const;
  /// Sets the limit of another scheme's tries, by which the first try of this scheme is judged. It must outlive this
  /// object.
  void judge_first_by(const JudgedMotion& limit) { other_limit_ = &limit; }

  /// Makes the next try. Returns false if a step has failed or the run was interrupted; `run.end` says which.
  bool attempt(AccurateRun& run);
  /// Estimates the error of the last try from its difference from the one before, or from the other scheme's limit,
  /// unless the try is astray. Returns true if no further try should be made; `run.end` says why.
  bool judge(AccurateRun& run);
  /// Gives the next try more steps. `failed`: the last try was not judged. Returns false if too many tries have failed
  /// in turn.
  bool go_on(bool failed);

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  void set_steps();
  /// Whether the last try is astray: steps had to be halved or solved from another guess, and Newton's method needed
  /// more iterations than for the longer steps of the try before. Then the error has no expansion in the step.
  bool is_astray() const {
    const double iterations = static_cast<double>(stepping_.iterations);
    return stepping_.recoveries > 0 && iterations / planned_ > iterations_per_step();
  }
  /// Whether an estimate is confirmed: by a third try, whose steps, unlike those of the second, are not nested in those
  /// of the try before. The first try is confirmed by the limit of another scheme.
  bool is_confirmed() const { return judged_ > 2 || (judged_ == 1 && other_limit_); }
  /// What the next try is compared to (null: nothing), and the part of the difference that is its error.
  const JudgedMotion* compared() const { return judged_ > 0 ? &before_ : other_limit_; }
  double compared_share() const { return judged_ > 0 ? share(scheme_.order, planned_before_) : 1; }
  double supposed_order(double difference) const;
  double share(double order, double planned) const;
  double estimate_of(const JudgedMotion& motion, double scale);

  Simulation& simulation_;
  const TryPlan& plan_;
  Snapshot start_;
  Scheme scheme_;
  double spent_ = 0;
  LocatedSteps stepping_;
  int steps_ = 0, next_ = 1;  // in the longest cell, in the last and in the next try
  double planned_ = 0;        // steps of the last try
  double expected_ = kUnknown;
  int failures_ = 0, stagnations_ = 0, unsettled_ = 0, judged_ = 0;
  bool was_resolved_ = true;  // whether steps of the last judged try turned nodes by small angles
  const JudgedMotion* other_limit_ = nullptr;
  JudgedMotion limit_;
  // Of the last judged try, and of the one judged before it.
  JudgedMotion before_, earlier_;
  double planned_before_ = kUnknown, planned_earlier_ = kUnknown;
  double estimate_ = kUnknown, difference_ = kUnknown, iterations_before_ = kUnknown;
};

}  // namespace flexarm
