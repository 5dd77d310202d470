#pragma once
/// The time integration schemes as data: a scheme is a row of rules and options, found by its name.

#include <optional>
#include <string_view>
#include <vector>

#include "schemes/time_rule.h"

namespace flexarm {

/// Default spectral radius at infinite frequency, for the dissipative schemes.
constexpr double kDefaultRho = 0.8;

/// Options of <integrator> that only some schemes have.
struct SchemeOptions {
  bool beta = false, gamma = false, alpha = false, rho_infinity = false;
  bool interpolation = false;  ///< interpolations other than Interpolation::Local
  bool iterative = false;      ///< Interpolation::Iterative; requires `interpolation`
  bool additive = false;       ///< WeakForm::Additive
  bool substitute = false;     ///< OnFailure::Dissipate: edmc2 can continue from its states, and it from those of edmc2
};

/// Number of second-order sub-steps of a composed step; one of them is backwards (Suzuki 1990).
constexpr int kCompositionSteps = 5;

/// A scheme by name: its rule for the elements, its properties, and the options that a scene can set.
struct Scheme : TimeRule {
  std::string_view name, description;
  bool conserves_energy = false, conserves_momenta = false;
  int order = 2;                               ///< order of accuracy in time
  bool is_composition = false;                 ///< fourth order by sub-steps of a symmetric second-order scheme
  bool heeds_slide_schemes = true;             ///< use the schemes that sliders name; false: SM-EM for all sliders
  double blur = IntegratorDescription().step;  ///< of touches, see CoordinateStep::blur [s]
  bool may_be_planar = true;                   ///< steps may be taken in a plane; false: always three-dimensional
  SchemeOptions options;

  int solves_per_step() const { return is_composition ? kCompositionSteps : 1; }
};

/// All implicit schemes with their default options; the default scheme is the first.
const std::vector<Scheme>& schemes();
/// Explicit schemes, which simulate rigid links only.
const std::vector<Scheme>& explicit_schemes();
/// The scheme with that name and default options; "auto" is the default scheme. Empty if the name is unknown.
std::optional<Scheme> find_scheme(std::string_view name);
/// The static rule with the scheme's interpolation, for equilibria: forces in one configuration, without motion.
Scheme statics_of(Scheme scheme);
/// The scheme with the interpolation and the weak form that do not depend on the path to a configuration.
Scheme with_local_strains(Scheme scheme);
/// All schemes that a name in a scene can stand for: two for "auto", none if the name is unknown.
std::vector<const Scheme*> meanings(std::string_view name);
/// The scheme with the options of <integrator>. "auto" becomes edmc2 if rho_infinity requests numerical dissipation.
/// @throws ModelError naming the option that does not suit the scheme, or an unknown scheme.
Scheme make_scheme(const IntegratorDescription& integrator);

/// Gives a scheme of `integrator` the constants that follow from this step [s]: those of numerical dissipation, the
/// relaxation time of dampers, and the blur of touches. Their effect is of second order in the step (of first, for
/// dissipation of first order).
void take_constants_of_step(Scheme& scheme, const IntegratorDescription& integrator, double step);

/// Coefficients of numerical dissipation for a spectral radius rho_infinity in [0, 1] at infinite frequency. `order`: 1
/// or 2; `step`: step size [s].
NumericalDissipation numerical_dissipation(int order, double rho_infinity, double step);

}  // namespace flexarm
