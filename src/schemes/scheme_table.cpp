// The table of schemes: one row per scheme, with its name, its traits and a description.
#include "schemes/explicit_tableau.h"
#include "schemes/scheme.h"

namespace flexarm {
namespace {

constexpr double kDefaultAlpha = -0.05;

/// A property that several schemes share. A row lists the traits of its scheme, the family first.
using Trait = void (*)(Scheme&);

// ---------------------------------------------------------------- families

void energy_momentum(Scheme& scheme) {
  scheme.damping_relaxation = IntegratorDescription().step;
  scheme.conserves_momenta = true;
  scheme.options.substitute = true;
}

/// Rotary inertia at the mass points, moments by T(omega) (see StressRule).
void exponential(Scheme& scheme) {
  scheme.stress = StressRule::ExponentialMoment;
  scheme.beam_rotation = scheme.body_rotation = RotationRule::Unscaled;
  scheme.nodal_rotary_inertia = false;
  scheme.conserves_momenta = true;
  scheme.options.interpolation = scheme.options.iterative = true;
}

/// As exponential(), with moments by S(w).
void cayley(Scheme& scheme) {
  exponential(scheme);
  scheme.stress = StressRule::CayleyMoment;
  scheme.beam_rotation = scheme.body_rotation = RotationRule::TangentScaled;
}

void end_point(Scheme& scheme) {
  scheme.stress = StressRule::EndPoint;
  scheme.beam_rotation = scheme.body_rotation = RotationRule::Unscaled;
  scheme.nodal_rotary_inertia = false;
  scheme.options.interpolation = scheme.options.iterative = scheme.options.additive = true;
}

// ---------------------------------------------------------------- energy

/// With an energy correction, bodies use the tangent-scaled rule, because the increments conjugate to the residual
/// require it.
template <EnergyCorrection correction>
void corrected(Scheme& scheme) {
  scheme.correction = correction;
  scheme.body_rotation = RotationRule::TangentScaled;
  scheme.conserves_energy = true;
}

template <int order>
void dissipative(Scheme& scheme) {
  scheme.dissipation = numerical_dissipation(order, kDefaultRho, IntegratorDescription().step);
  scheme.order = order;
  scheme.conserves_energy = false;
  scheme.options.rho_infinity = true;
  scheme.options.substitute = false;
}

void backward(Scheme& scheme) {
  scheme.backward_velocity = true;
  scheme.order = 1;
}

/// The interpolation is a part of the scheme's energy balance, so that a scene cannot choose another one.
void cayley_interpolated(Scheme& scheme) {
  scheme.interpolation = Interpolation::Incremental;
  scheme.cayley_interpolation = scheme.conserves_energy = true;
  scheme.options.interpolation = scheme.options.iterative = false;
}

// ---------------------------------------------------------------- time

void symmetric(Scheme& scheme) {
  scheme.mid_functions = MidFunctions::Symmetric;
}

void composed(Scheme& scheme) {
  scheme.is_composition = true;
  scheme.order = 4;
  scheme.damping_relaxation = 0;  // its effect is of second order in the scene's step and would spoil the fourth order
}

void newmark(Scheme& scheme) {
  scheme.options.beta = scheme.options.gamma = true;
}

template <HhtForm form>
void hht(Scheme& scheme) {
  scheme.hht = form;
  scheme.set_alpha(kDefaultAlpha);
  scheme.options.alpha = true;
  if (form == HhtForm::Kinematics) scheme.options.iterative = false;  // it evaluates two configurations per iterate
}

struct Row {
  std::string_view name;
  std::vector<Trait> traits;
  std::string_view description;
};

std::vector<Scheme> build_table() {
  constexpr Trait multiplier = corrected<EnergyCorrection::Multiplier>;
  constexpr Trait axial = corrected<EnergyCorrection::AxialBeta>, full = corrected<EnergyCorrection::FullBeta>;
  const Row rows[] = {
      {"em", {energy_momentum, multiplier}, "invariant energy-momentum scheme, one multiplier per element"},
      {"em0", {energy_momentum}, "its base, without the multiplier: momenta exact, energy approximate"},
      {"em_symmetric", {energy_momentum, multiplier, symmetric}, "em, symmetric in time"},
      {"em4",
       {energy_momentum, multiplier, symmetric, composed},
       "fourth order: five steps of em_symmetric, one of them backwards"},
      {"edmc1", {energy_momentum, multiplier, dissipative<1>}, "em with numerical dissipation of first order"},
      {"edmc2", {energy_momentum, multiplier, dissipative<2>}, "em with numerical dissipation of second order"},
      {"m1", {exponential}, "momentum-conserving scheme M1 (Muñoz 2004, sec. 6.3)"},
      {"m2", {exponential, backward}, "momentum-conserving, dissipative scheme M2 (Muñoz 2004, sec. 6.3)"},
      {"std",
       {cayley, cayley_interpolated},
       "Simo, Tarnow and Doblaré's energy-momentum scheme (Muñoz 2004, sec. 6.2)"},
      {"beta1", {exponential, axial}, "M1 with its energy corrected (Muñoz 2004, eq. 6.22)"},
      {"beta2", {cayley, axial}, "STD, local interpolation, energy corrected (eq. 6.26)"},
      {"beta1_repaired", {exponential, full}, "beta1, correction by forces and moments"},
      {"beta2_repaired", {cayley, full}, "beta2, correction by forces and moments"},
      {"newmark", {end_point, newmark}, "Newmark's rule (Muñoz 2004, ch. 4)"},
      {"hht1",
       {end_point, hht<HhtForm::AdditiveForces>},
       "Hilber-Hughes-Taylor, additive forces interpolated (eq. 4.10)"},
      {"hht2", {end_point, hht<HhtForm::SpinForces>}, "Hilber-Hughes-Taylor, spin forces interpolated (eq. 4.11)"},
      {"hht3", {end_point, hht<HhtForm::Kinematics>}, "Hilber-Hughes-Taylor, kinematics interpolated (eq. 4.12, 4.13)"},
  };
  std::vector<Scheme> table;
  for (const Row& row : rows) {
    Scheme& scheme = table.emplace_back();
    scheme.name = row.name;
    scheme.description = row.description;
    for (const Trait trait : row.traits) trait(scheme);
  }
  return table;
}

}  // namespace

const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> table = build_table();
  return table;
}

const std::vector<Scheme>& explicit_schemes() {
  static const std::vector<Scheme> table = [] {
    std::vector<Scheme> out(2);
    out[0].name = "rk4", out[0].order = 4, out[0].tableau = &rk4_tableau();
    out[0].description = "explicit Runge-Kutta method of order 4, for rigid links";
    out[1].name = "dop853", out[1].order = 8, out[1].tableau = &dop853_tableau();
    out[1].description = "explicit Runge-Kutta method of order 8 (Hairer, Norsett and Wanner 1993), for rigid links";
    return out;
  }();
  return table;
}

}  // namespace flexarm
