#pragma once
/// What the elements need to know of a time integration scheme.

namespace flexarm {

/// Where in a step the stress is taken.
enum class StressRule {
  EndPoint,          ///< at t_{n+1} (statics, Newmark)
  Average,           ///< EM0
  DiscreteGradient,  ///< EM
  Exponential        ///< M1
};

/// How a material angular velocity follows the rotation over a step.
enum class RotationRule {
  TangentScaled,  ///< (W_0 + W_1)/2 = Omega/h with the tangent-scaled increment: the one that joints map exactly
  Unscaled        ///< with the rotation vector
};

struct TimeRule {
  StressRule stress;
  RotationRule rotation;      ///< conserving schemes
  bool nodal_rotary_inertia;  ///< lumped at the nodes; else integrated at the mass points
  double beta, gamma;         ///< Newmark family

  /// True for the schemes whose joints use the incremental maps N_Delta; false: N_delta at t_{n+1}.
  bool is_incremental() const { return stress != StressRule::EndPoint; }
};

}  // namespace flexarm
