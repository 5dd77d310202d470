#pragma once
/// The time integration schemes as data.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flexarm {

/// How a scheme treats stress and rotary inertia over a step.
enum class StressRule {
  EndPoint,          ///< at t_{n+1} (statics, Newmark)
  Average,           ///< EM0
  DiscreteGradient,  ///< EM
  Exponential        ///< M1
};
enum class RotationRule {
  TangentScaled,  ///< (W_0 + W_1)/2 = Omega/h with the tangent-scaled increment: the one that joints map exactly
  Unscaled        ///< with the rotation vector
};

struct Scheme {
  std::string_view name;
  StressRule stress;
  RotationRule rotation;      ///< conserving schemes
  bool nodal_rotary_inertia;  ///< lumped at the nodes; else integrated at the mass points
  double beta, gamma;         ///< Newmark family
  bool conserves_energy, conserves_momenta;
  std::string_view description;

  /// True for the schemes whose joints use the incremental maps N_Delta; false: N_delta at t_{n+1}.
  bool is_incremental() const { return stress != StressRule::EndPoint; }
};

/// All schemes, the default first.
const std::vector<Scheme>& schemes();
/// By name; "auto" is the default. Empty if unknown.
std::optional<Scheme> find_scheme(std::string_view name);

}  // namespace flexarm
