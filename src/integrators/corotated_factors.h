#pragma once
/// Factors of a tangent that go on serving while the mechanism turns.

#include <vector>

#include "integrators/step_configuration.h"

namespace flexarm {

/// Solves with the tangent of a step, or with an older one whose nodes have turned since. In the nodes' own frames a
/// tangent changes with the deformation only, and with what holds the mechanism to the world: if Q_i is the rotation of
/// node i since the factors were made and Q that of all unknowns (released coordinates keep theirs), then
///   Q A Q^T x = b   is solved by   x = Q A^-1 Q^T b,
/// and Q A Q^T is the tangent itself where the whole turns rigidly under what turns with it. (docs/notes/step.md)
class CorotatedFactors {
 public:
  /// Both must outlive it.
  CorotatedFactors(const StepConfiguration& configuration, TangentBackend& tangent);

  /// Of the tangent evaluated last. False if it is singular or not finite.
  bool make();
  /// Replaces b, one entry per unknown, by the solution with factors of the tangent evaluated last. False if that is not
  /// finite; so does the next one.
  bool solve(Eigen::VectorXd& b) { return tangent_.solve(b); }
  /// The same with factors made at another configuration, turned to the present one.
  bool solve_turned(Eigen::VectorXd& b);

 private:
  struct FreeNode {
    int node, equation;
  };
  const StepConfiguration& configuration_;
  TangentBackend& tangent_;
  std::vector<FreeNode> free_nodes_;      // whose motion is unknown
  std::vector<Matrix3> made_at_, turns_;  // per free node: its rotation when the factors were made, and since
};

}  // namespace flexarm
