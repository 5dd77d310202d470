#pragma once
/// The time integration schemes as data.

#include <optional>
#include <string_view>
#include <vector>

#include "schemes/time_rule.h"

namespace flexarm {

/// Spectral radius at infinite frequency of the dissipative schemes where a scene does not say it.
constexpr double kDefaultRho = 0.8;

/// Steps that a contact with a stop lasts.
constexpr double kContactSteps = 10;

/// Options of <integrator> that only some schemes take.
struct SchemeOptions {
  bool beta = false, gamma = false, alpha = false, rho_infinity = false;
  bool interpolation = false;  ///< others than the local one
  bool iterative = false;      ///< among them the one from iterate to iterate
  bool additive = false;       ///< WeakForm::Additive
  bool substitute = false;     ///< OnFailure::Dissipate: its state is one that edmc2 can go on from, and back
};

/// Steps of second order, one of them backwards, that make one of a composition (Suzuki 1990).
constexpr int kCompositionSteps = 5;

/// A scheme by name: its rule for the elements, what it claims, and what a scene may say of it.
struct Scheme : TimeRule {
  std::string_view name, description;
  bool conserves_energy = false, conserves_momenta = false;
  int order = 2;                    ///< in time
  bool is_composition = false;      ///< sub-steps of a symmetric second-order step: order four
  bool heeds_slide_schemes = true;  ///< else the contact of all sliders is carried by SM-EM
  /// Of what touches a stop [s]: resolved by the scene's steps, and short to the eye.
  double contact_time = kContactSteps * IntegratorDescription().step;
  bool may_be_planar = true;  ///< else all is three-dimensional, the scene of a plane, too
  SchemeOptions options;

  int solves_per_step() const { return is_composition ? kCompositionSteps : 1; }
};

/// All schemes with their default options, the default scheme first.
const std::vector<Scheme>& schemes();
/// By name, default options; "auto" is the default scheme. Empty if unknown.
std::optional<Scheme> find_scheme(std::string_view name);
/// The rule by which a scheme's interpolation finds equilibria: forces at the configuration, nothing moves.
Scheme statics_of(Scheme scheme);
/// Those of the table that a name in a scene may mean: several for "auto", none if unknown.
std::vector<const Scheme*> meanings(std::string_view name);
/// With the options of <integrator>; "auto" becomes edmc2 where rho_infinity asks for numerical dissipation.
/// @throws ModelError naming the option that does not suit the scheme, or an unknown scheme.
Scheme make_scheme(const IntegratorDescription& integrator);

/// Coefficients for a spectral radius rho_infinity in [0, 1] at infinite frequency, of first or second order, for steps
/// of the given length [s].
NumericalDissipation numerical_dissipation(int order, double rho_infinity, double step);

}  // namespace flexarm
