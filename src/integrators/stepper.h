#pragma once
/// Newton's method for one step, and the step control around it: halve on failure, recover after success.

#include <optional>

#include "integrators/factor_reuse.h"
#include "integrators/step_system.h"
#include "integrators/velocity_scaling.h"

namespace flexarm {

/// Outcome of a step; a value, never an exception.
struct StepResult {
  enum class Reason {
    None,
    NoConvergence,
    SingularTangent,
    NotFinite,
    RotationTooLarge,
    EnergyDefect,
    OffTheLine,
    OpenLoop
  };
  bool converged = false;
  int iterations = 0;  ///< Newton iterations of all sub-steps
  int halvings = 0;    ///< times that a sub-step had to be halved
  int factorisations = 0;
  Reason reason = Reason::None;  ///< why it failed
};
const char* to_string(StepResult::Reason reason);

/// Settings of Newton's method and of the step control.
struct StepSettings {
  double step = 1e-3;       ///< [s]
  double tolerance = 1e-8;  ///< on the largest update: displacements over the model's length scale, rotations in rad
  int max_iterations = 20;
  int max_halvings = 5;
  /// Keep the factors of the tangent while the iteration contracts well (modified Newton). The result agrees with that
  /// of full Newton to far below the tolerance; off: quadratic convergence, and a restored state continues bit for bit.
  bool reuse_factorisation = true;
};

/// Advances states of one model with one scheme. Allocates nothing after the first step, but when a
/// slider enters another element (see SparseAssembler).
class Stepper {
 public:
  Stepper(const Model& model, const Scheme& scheme, const StepSettings& settings);

  /// One step of settings.step, in sub-steps of step / 2^k where Newton needs them. On failure the state is that after
  /// the last good sub-step.
  StepResult advance(State& state);
  /// Equilibrium by `load_steps` equal increments of gravity and loads, halved where Newton asks for it. On failure the
  /// state is untouched.
  StepResult solve_static(State& state, int load_steps);
  /// Adds to an initial state what the scheme keeps there; accelerations (Newmark family) come from a short
  /// momentum-conserving step.
  void initialise(State& state);
  /// The state was changed by somebody else: forget what was kept from the last step.
  void invalidate();

  const StepSettings& settings() const { return settings_; }
  /// Update norms of the last Newton solve, for tests of the rate of convergence.
  const std::vector<double>& update_norms() const { return update_norms_; }
  const DegreesOfFreedom& degrees_of_freedom() const { return system_.degrees_of_freedom(); }

 private:
  enum class Updates { Full, Limited };
  /// Newton from the present trial configuration; leaves the system evaluated at the solution. With `reuse` it starts
  /// with the factors of an earlier solve where these have shown to do, and makes new ones where the iteration is slow.
  bool iterate(Updates updates, bool reuse, StepResult& result);
  void initialise_accelerations(State& state);
  /// A step of a composed scheme is several simple ones; on failure the state is untouched.
  bool sub_step(State& state, double step, StepResult& result);
  bool simple_step(State& state, double step, StepResult& result);

  const Model& model_;
  Scheme scheme_;
  StepSettings settings_;
  StepSystem system_;
  Eigen::VectorXd update_;
  std::optional<VelocityScaling> scaling_;
  State before_;                // of a step that may have to be taken back
  double factorised_step_ = 0;  ///< step size for which the factors hold; 0: none
  FactorReuse factor_reuse_;
  std::vector<double> update_norms_;
};

}  // namespace flexarm
