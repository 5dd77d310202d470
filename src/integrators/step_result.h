#pragma once
/// What is asked of a step, and what it came to.

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

}  // namespace flexarm
