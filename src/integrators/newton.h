#pragma once
/// Newton's method for the equations of a step.

#include <array>
#include <vector>

#include "flexarm/model/results.h"
#include "integrators/factor_reuse.h"
#include "integrators/step_observer.h"
#include "integrators/step_settings.h"
#include "integrators/step_system.h"

namespace flexarm {

/// Solves a StepSystem from its present trial configuration, with new factors or those of an earlier solve.
class NewtonIteration {
 public:
  enum class Updates {
    Full,
    Limited  ///< large rotations are scaled down
  };
  /// Where a solve may start with the factors of an earlier one.
  enum class Factors { Fresh, MayBeKept };

  /// Both must outlive the iteration.
  NewtonIteration(StepSystem& system, const StepSettings& settings);

  /// Leaves the system evaluated at the solution. Counts iterations and factorisations in `result`, and puts the reason
  /// there if it fails.
  bool solve(Updates updates, Factors factors, StepResult& result);
  /// In the last solve: an update by kept factors.
  bool made_kept_updates() const { return made_kept_updates_; }
  /// Discards the factors of earlier steps.
  void forget_factors();
  /// Update norms of the last solve.
  const std::vector<double>& update_norms() const { return norms_; }
  /// Null: nobody.
  void observe(StepObserver* observer) { observer_ = observer; }

 private:
  using Reason = StepResult::Reason;
  /// What an update tells of how the iteration goes.
  struct Progress {
    int iteration = 0;               // of the solve
    int since_revision = 0;          // updates of the same equations before this one
    bool with_kept = false;          // factors
    bool kept_before = false;        // of the update before this one
    double norm = 0;                 // of the update
    double fraction = 1;             // of the solution that it is
    double damping = 1;              // share of an update that is made at a steep law
    int done_well = 0;               // updates in a row with this damping that did
    double contraction = 1;          // its ratio to the one before; 1 where there is none
    bool started_with_kept = false;  // factors of the solve's first update
    double first_residual = 0;       // norm before it
    double residual = 0;             // norm before the update; where something may be hit
  };

  /// How a solve went on after its first update: the expectation for the next solve with the same kind of start.
  struct FirstUpdate {
    double norm = 0, contraction = 1;
    double residual_ratio = 1;  // of the residual after it to that before
    int age = 0;                // solves since, that did without a second update
    bool is_known = false;
  };
  /// The contraction by kept factors in the third update of a solve, which is what the second one left.
  struct KeptContraction {
    double contraction = 1;
    int age = 0;  // solves since that started alike
    bool is_known = false;
  };

  Reason iterate(Updates updates, Factors factors, StepResult& result);
  Reason evaluate(bool with_tangent);
  Reason find_update(Updates updates, Progress& progress);
  bool diverges(const Progress& progress) const;
  bool is_led_astray(const Progress& progress) const;
  bool is_useless(const Progress& progress) const;
  bool kept_leave_more_than(double share, const Progress& progress) const;
  void damp(Progress& progress);
  bool has_converged(const Progress& progress, Factors factors) const;
  double remainder_after(const Progress& progress) const;
  double contraction_after(const Progress& progress) const;
  bool renews_factors(const Progress& progress) const;
  double target() const;
  void learn(Progress& progress);
  bool is_as_expected(const Progress& progress) const;
  void enter(StepPhase phase) {
    if (observer_) observer_->enter(phase);
  }

  StepSystem& system_;
  const StepSettings& settings_;
  FactorReuse factor_reuse_;
  double factorised_step_ = 0;  // for which the factors hold; 0: none
  bool made_kept_updates_ = false;
  Eigen::VectorXd update_;
  std::vector<double> norms_;
  std::array<FirstUpdate, 2> starts_;                 // with fresh and with kept factors
  std::array<KeptContraction, 2> kept_contractions_;  // of solves that start so
  StepObserver* observer_ = nullptr;
};

}  // namespace flexarm
