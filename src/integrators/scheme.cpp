#include "integrators/scheme.h"

#include <fmt/format.h>

#include "model/model_builder.h"
#include "scene/integrator_options.h"

namespace flexarm {
namespace {

constexpr double kDefaultRho = 0.8, kDefaultAlpha = -0.05;

Scheme energy_momentum(std::string_view name, std::string_view description) {
  Scheme scheme;
  scheme.name = name;
  scheme.description = description;
  scheme.correction = EnergyCorrection::Multiplier;
  scheme.damping_relaxation = scene::IntegratorDescription().step;
  scheme.conserves_energy = scheme.conserves_momenta = true;
  return scheme;
}

Scheme without_correction(Scheme scheme) {
  scheme.correction = EnergyCorrection::None;
  scheme.conserves_energy = false;
  return scheme;
}

Scheme symmetric(Scheme scheme) {
  scheme.mid_functions = MidFunctions::Symmetric;
  return scheme;
}

Scheme dissipative(Scheme scheme, int order) {
  scheme.dissipation = numerical_dissipation(order, kDefaultRho, scene::IntegratorDescription().step);
  scheme.order = order;
  scheme.conserves_energy = false;
  return scheme;
}

/// Rotary inertia at the mass points, moments by T(omega) or S(w).
Scheme momentum(std::string_view name, StressRule stress, std::string_view description) {
  Scheme scheme;
  scheme.name = name;
  scheme.description = description;
  scheme.stress = stress;
  if (stress == StressRule::ExponentialMoment) scheme.beam_rotation = scheme.body_rotation = RotationRule::Unscaled;
  scheme.nodal_rotary_inertia = false;
  scheme.conserves_momenta = true;
  return scheme;
}

/// Bodies take the tangent-scaled rule: it is what the increments conjugate to the residual ask for.
Scheme corrected(Scheme scheme, EnergyCorrection correction) {
  scheme.correction = correction;
  scheme.body_rotation = RotationRule::TangentScaled;
  scheme.conserves_energy = true;
  return scheme;
}

Scheme newmark(std::string_view name, HhtForm hht, std::string_view description) {
  Scheme scheme;
  scheme.name = name;
  scheme.description = description;
  scheme.stress = StressRule::EndPoint;
  scheme.beam_rotation = scheme.body_rotation = RotationRule::Unscaled;
  scheme.nodal_rotary_inertia = false;
  scheme.hht = hht;
  return scheme;
}

void set_alpha(Scheme& scheme, double alpha) {
  scheme.alpha = alpha;
  scheme.gamma = 0.5 - alpha;
  scheme.beta = 0.25 * (1 - alpha) * (1 - alpha);
}

std::vector<Scheme> build_table() {
  using Stress = StressRule;
  std::vector<Scheme> table = {
      energy_momentum("em", "invariant energy-momentum scheme, one multiplier per element"),
      without_correction(energy_momentum("em0", "its base, without the multiplier: momenta exact, energy approximate")),
      without_correction(energy_momentum("em_scaled", "em0 and a scaling of the velocities that closes the energy")),
      symmetric(energy_momentum("em_symmetric", "em, symmetric in time")),
      symmetric(energy_momentum("em4", "fourth order: five steps of em_symmetric, one of them backwards")),
      dissipative(energy_momentum("edmc1", "em with numerical dissipation of first order"), 1),
      dissipative(energy_momentum("edmc2", "em with numerical dissipation of second order"), 2),
      momentum("m1", Stress::ExponentialMoment, "momentum-conserving scheme M1 (Muñoz 2004, sec. 6.3)"),
      momentum("m2", Stress::ExponentialMoment, "momentum-conserving, dissipative scheme M2 (Muñoz 2004, sec. 6.3)"),
      momentum("std", Stress::CayleyMoment, "Simo, Tarnow and Doblaré's energy-momentum scheme (Muñoz 2004, sec. 6.2)"),
      corrected(momentum("beta1", Stress::ExponentialMoment, "M1 with its energy corrected (Muñoz 2004, eq. 6.22)"),
                EnergyCorrection::AxialBeta),
      corrected(momentum("beta2", Stress::CayleyMoment, "STD, local interpolation, energy corrected (eq. 6.26)"),
                EnergyCorrection::AxialBeta),
      corrected(momentum("beta1_repaired", Stress::ExponentialMoment, "beta1, correction by forces and moments"),
                EnergyCorrection::FullBeta),
      corrected(momentum("beta2_repaired", Stress::CayleyMoment, "beta2, correction by forces and moments"),
                EnergyCorrection::FullBeta),
      newmark("newmark", HhtForm::None, "Newmark's rule (Muñoz 2004, ch. 4)"),
      newmark("hht1", HhtForm::AdditiveForces, "Hilber-Hughes-Taylor, additive forces interpolated (eq. 4.10)"),
      newmark("hht2", HhtForm::SpinForces, "Hilber-Hughes-Taylor, spin forces interpolated (eq. 4.11)"),
      newmark("hht3", HhtForm::Kinematics, "Hilber-Hughes-Taylor, kinematics interpolated (eq. 4.12, 4.13)"),
  };
  for (Scheme& scheme : table) {
    if (scheme.name == "em_scaled") scheme.scales_velocities = scheme.conserves_energy = true;
    if (scheme.name == "em4") {
      scheme.is_composition = true;
      scheme.order = 4;
      scheme.damping_relaxation = 0;  // its effect is of second order in the scene's step, not in those composed
    }
    if (scheme.name == "m2") scheme.backward_velocity = true, scheme.order = 1;
    if (scheme.name == "std") {
      scheme.interpolation = Interpolation::Incremental;
      scheme.cayley_interpolation = scheme.conserves_energy = true;
    }
    if (scheme.hht != HhtForm::None) set_alpha(scheme, kDefaultAlpha);
  }
  return table;
}

}  // namespace

NumericalDissipation numerical_dissipation(int order, double rho, double step) {
  if (rho >= 1) return {};
  // In p = (z - 1)/(z + 1), z the factor per step, the infinitely stiff spring has all its roots at -P.
  const double P = (1 + rho) / (1 - rho);
  if (order == 1) return {1 / P, 0, 0.25 * step * step / (P * P)};
  return {4 / (3 * P * (3 + P)), 2 * P / (3 + P), step * step / (12 * P * P)};
}

const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> table = build_table();
  return table;
}

std::optional<Scheme> find_scheme(std::string_view name) {
  if (name == "auto") return schemes().front();
  for (const Scheme& scheme : schemes())
    if (scheme.name == name) return scheme;
  return std::nullopt;
}

Scheme statics_of(Scheme scheme) {
  scheme.is_static = true;
  scheme.stress = StressRule::EndPoint;
  return scheme;
}

Scheme make_scheme(const scene::IntegratorDescription& integrator) {
  const bool wants_dissipation = integrator.scheme == "auto" && integrator.rho_infinity.value_or(1) < 1;
  const std::optional<Scheme> found = find_scheme(wants_dissipation ? "edmc2" : integrator.scheme);
  if (!found)
    throw ModelError(fmt::format("unknown integration scheme '{}', expected one of: {}", integrator.scheme,
                                 fmt::join(scene::scheme_names(), " ")));
  for (const scene::OptionConflict& conflict : scene::option_conflicts(integrator))
    throw ModelError(fmt::format("<integrator>: {}: {}", conflict.attribute, conflict.message));
  Scheme scheme = *found;
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw ModelError(fmt::format("<integrator>: {}", what));
  };
  if (integrator.beta) scheme.beta = *integrator.beta;
  if (integrator.gamma) scheme.gamma = *integrator.gamma;
  require(scheme.beta > 0 && scheme.gamma > 0, "beta and gamma must be > 0");
  if (scheme.name == "newmark" && scheme.gamma != 0.5) scheme.order = 1;
  if (integrator.alpha) set_alpha(scheme, *integrator.alpha);
  require(scheme.alpha >= -1.0 / 3 && scheme.alpha <= 0, "alpha must be from -1/3 to 0");
  if (integrator.interpolation) scheme.interpolation = *integrator.interpolation;
  if (integrator.weak_form) scheme.weak_form = *integrator.weak_form;
  if (scheme.damping_relaxation > 0) scheme.damping_relaxation = integrator.step;
  const double rho = integrator.rho_infinity.value_or(kDefaultRho);
  require(rho >= 0 && rho <= 1, "rho_infinity must be from 0 to 1");
  if (scheme.dissipation.any()) {
    scheme.dissipation = numerical_dissipation(scheme.order, rho, integrator.step);
    scheme.conserves_energy = !scheme.dissipation.any();
  }
  return scheme;
}

}  // namespace flexarm
