#pragma once
/// Interface for observers of the phases of a step, such as profilers.

namespace flexarm {

/// Factorise: factorises the last tangent and solves with its factors. Solve: solves with factors of an earlier
/// tangent.
enum class StepPhase { Begin, Residual, Tangent, Factorise, Solve, Update, Accept, Control };

class StepObserver {
 public:
  virtual ~StepObserver() = default;
  /// A phase begins, and the phase before it has ended.
  virtual void enter(StepPhase phase) = 0;
};

}  // namespace flexarm
