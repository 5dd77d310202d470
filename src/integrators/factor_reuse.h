#pragma once
/// Decides when Newton's method factorises its tangent anew, and when it keeps the factors.

#include <array>

namespace flexarm {

/// An update of a solve, and what is expected of the next ones.
struct UpdateOutlook {
  double norm = 0;         ///< scaled
  double contraction = 0;  ///< by which kept factors go on; 0: unknown
  bool is_by_new = false;  ///< factors
  double target = 0;       ///< for the norm of what is left
};

/// A solve makes new factors in its first iterations, or in all: their number is its plan. The plan is learned from the
/// cost of earlier solves: the cheapest one is used, and now and then its neighbours are tried. After the first
/// iterations new factors are made if kept ones would take longer for the missing digits.
class FactorReuse {
 public:
  /// `cost`: of an iteration with new factors over that of one with kept ones, see TangentBackend.
  explicit FactorReuse(double cost);

  /// Forgets all that was learned.
  void reset() { *this = FactorReuse(cost_of_factors_); }

  /// Starts a solve by a plan. Returns whether its first iteration makes new factors. `hold`: there are factors of such
  /// a system.
  bool begin(bool hold);
  /// Whether iteration `next` (the first is 0) makes new factors, after `update`.
  bool renew(int next, const UpdateOutlook& update) const;
  /// Ends a solve. The cost of a failed solve includes those that are made instead of it, with any plan or none.
  void end(int iterations, int factorisations, bool converged);

 private:
  static constexpr int kFull = 3;  // the plan of full Newton: new factors in all iterations
  struct Plan {
    double cost = 0;  // of its solves, in iterations with kept factors: a mean that forgets
    bool is_known = false;
    double open_cost = 0;  // of one that is not solved yet
    bool is_open = false;
  };

  int cheapest() const;
  void record(Plan& plan);

  double cost_of_factors_;
  std::array<Plan, kFull + 1> plans_;  // by first iterations with new factors
  int planned_ = 0;                    // of this solve
  int tried_ = -1;                     // the plan on trial; -1: none
  bool tries_more_ = true;
  double pause_ = 0;  // solves from one trial to the next
  int since_trial_ = 0;
};

}  // namespace flexarm
