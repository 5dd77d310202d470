#pragma once
/// Decides in which iterations Newton's method factorises its tangent, and in which it reuses the factors.

#include <array>

namespace flexarm {

/// The size of an update, and what is expected of the following ones.
struct UpdateOutlook {
  double norm = 0;         ///< scaled norm
  double contraction = 0;  ///< expected ratio of successive updates with kept factors; 0: unknown
  bool is_by_new = false;  ///< whether the update was made with new factors
  double target = 0;       ///< required norm of the remaining error
};

/// The number of first iterations with new factors in a solve, or "all", is called its plan. The plan is learned from
/// the cost of earlier solves: normally the cheapest plan is used, and now and then a neighbouring plan is tried. After
/// the first iterations, new factors are made if kept factors would take longer to reach the target.
class FactorReuse {
 public:
  /// `cost`: of an iteration with new factors relative to one with kept factors, see TangentBackend::cost_of_factors().
  explicit FactorReuse(double cost);

  /// Forgets everything that was learned.
  void reset() { *this = FactorReuse(cost_of_factors_); }

  /// Starts a solve and chooses its plan. Returns whether its first iteration makes new factors. `hold`: factors of the
  /// same kind of system are available.
  bool begin(bool hold);
  /// Whether iteration `next` (counted from 0) makes new factors, after `update`.
  bool renew(int next, const UpdateOutlook& update) const;
  /// Ends a solve. If it failed, the solves that replace it count as part of its cost, whatever plan they have.
  void end(int iterations, int factorisations, bool converged);

 private:
  static constexpr int kFull = 3;  // the plan of full Newton: new factors in all iterations
  struct Plan {
    double cost = 0;  // mean cost of its solves, in iterations with kept factors; older solves count less
    bool is_known = false;
    double open_cost = 0;  // cost so far of a solve that has not succeeded yet
    bool is_open = false;  // there is such a solve
  };

  int cheapest() const;
  void record(Plan& plan);

  double cost_of_factors_;
  std::array<Plan, kFull + 1> plans_;  // index: number of first iterations with new factors
  int planned_ = 0;                    // plan of the present solve
  int tried_ = -1;                     // plan on trial; -1: none
  bool tries_more_ = true;
  double pause_ = 0;  // number of solves between two trials
  int since_trial_ = 0;
};

}  // namespace flexarm
