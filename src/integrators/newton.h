#pragma once
/// Newton's method for the equations of a step, with reuse of factorisations.

#include <array>
#include <vector>

#include "flexarm/model/results.h"
#include "integrators/factor_reuse.h"
#include "integrators/step_observer.h"
#include "integrators/step_settings.h"
#include "integrators/step_system.h"

namespace flexarm {

/// Solves a StepSystem, starting from its present trial configuration. New factors are those of the present tangent;
/// kept factors are those of an earlier iteration or solve.
class NewtonIteration {
 public:
  enum class Updates {
    Full,
    Limited  ///< updates with large rotations are scaled down
  };
  /// Whether a solve may start with the factors of an earlier one.
  enum class Factors { Fresh, MayBeKept };

  /// `system` and `settings` must outlive the iteration.
  NewtonIteration(StepSystem& system, const StepSettings& settings);

  /// Leaves the system evaluated at the solution. Adds iterations and factorisations to `result`. Returns false after a
  /// failure, and writes its reason to `result`.
  bool solve(Updates updates, Factors factors, StepResult& result);
  /// Whether the last solve made an update with kept factors.
  bool made_kept_updates() const { return made_kept_updates_; }
  /// Discards the factors of earlier steps.
  void forget_factors();
  /// Update norms of the last solve.
  const std::vector<double>& update_norms() const { return norms_; }
  /// Sets the observer of phases; null: none.
  void observe(StepObserver* observer) { observer_ = observer; }

 private:
  using Reason = StepResult::Reason;
  /// The present update of a solve, and how the iteration goes.
  struct Progress {
    int iteration = 0;               // number of the update in this solve, from 0
    int since_revision = 0;          // number of earlier updates of the same equations
    bool with_kept = false;          // whether this update uses kept factors
    bool kept_before = false;        // whether the update before this one did
    double norm = 0;                 // of the update
    double fraction = 1;             // share of the full Newton update that is applied
    double damping = 1;              // share that damping on steep laws leaves
    int done_well = 0;               // number of consecutive good updates with this damping
    double contraction = 1;          // ratio of this update's norm to that of the one before; 1 if there is none
    bool started_with_kept = false;  // whether the first update of the solve used kept factors
    double first_residual = 0;       // norm of the residual before the first update
    double residual = 0;             // norm of the residual before this update; only if something may be hit
  };

  /// How a solve continued after its first update: the expectation for the next solve that starts with the same
  /// factors.
  struct FirstUpdate {
    double norm = 0, contraction = 1;
    double residual_ratio = 1;  // norm of the residual after the first update / before it
    int age = 0;                // number of solves since then that ended after one update
    bool is_known = false;
  };
  /// How much the third update of a solve is smaller than the second one, with kept factors.
  struct KeptContraction {
    double contraction = 1;
    int age = 0;  // number of solves since then with the same kind of start
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
  const bool has_falling_friction_;
  double factorised_step_ = 0;  // step size for which the factors are valid; 0: no factors
  bool made_kept_updates_ = false;
  Eigen::VectorXd update_;
  std::vector<double> norms_;
  std::array<FirstUpdate, 2> starts_;                 // [0]: started with new factors, [1]: with kept ones
  std::array<KeptContraction, 2> kept_contractions_;  // likewise
  StepObserver* observer_ = nullptr;
};

}  // namespace flexarm
