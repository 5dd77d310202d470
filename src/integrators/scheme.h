#pragma once
/// The time integration schemes as data.

#include <optional>
#include <string_view>
#include <vector>

#include "elements/time_rule.h"

namespace flexarm {

/// A scheme by name: its rule for the elements, and what it claims.
struct Scheme : TimeRule {
  std::string_view name;
  bool conserves_energy = false, conserves_momenta = false;
  int order = 2;                   ///< in time
  bool scales_velocities = false;  ///< closes the energy balance after the step (beyond.md 1.2)
  bool is_composition = false;     ///< five sub-steps of a symmetric second-order step: order four
  std::string_view description;
};

/// All schemes with their default options, the default scheme first.
const std::vector<Scheme>& schemes();
/// By name, default options; "auto" is the default scheme. Empty if unknown.
std::optional<Scheme> find_scheme(std::string_view name);
/// The rule by which a scheme's interpolation finds equilibria: forces at the configuration, nothing moves.
Scheme statics_of(Scheme scheme);
/// With the options of <integrator>; "auto" becomes edmc2 where rho_infinity asks for numerical dissipation.
/// @throws ModelError naming the option that does not suit the scheme, or an unknown scheme.
Scheme make_scheme(const scene::IntegratorDescription& integrator);

/// Coefficients for a spectral radius rho_infinity in [0, 1] at infinite frequency, of first or second order, for steps
/// of the given length [s].
NumericalDissipation numerical_dissipation(int order, double rho_infinity, double step);

}  // namespace flexarm
