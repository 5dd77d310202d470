#pragma once
/// An interface for observers of the phases of a step.

namespace flexarm {

/// Factorise: of the tangent that was evaluated last, with the solution that follows. Solve: with kept factors.
enum class StepPhase { Begin, Residual, Tangent, Factorise, Solve, Update, Accept, Control };

class StepObserver {
 public:
  virtual ~StepObserver() = default;
  /// A phase begins; the one before has ended.
  virtual void enter(StepPhase phase) = 0;
};

}  // namespace flexarm
