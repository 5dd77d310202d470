#include "schemes/scheme.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/model/model_error.h"

namespace flexarm {

NumericalDissipation numerical_dissipation(int order, double rho, double step) {
  if (rho >= 1) return {};
  // With p = (z - 1)/(z + 1), where z is the amplification factor per step: all roots of an infinitely stiff spring are
  // at -P.
  const double P = (1 + rho) / (1 - rho);
  if (order == 1) return {1 / P, 0, 0.25 * step * step / (P * P)};
  return {4 / (3 * P * (3 + P)), 2 * P / (3 + P), step * step / (12 * P * P)};
}

std::vector<const Scheme*> meanings(std::string_view name) {
  // "auto" without and with numerical dissipation.
  if (name == "auto") return {meanings("em").front(), meanings("edmc2").front()};
  for (const std::vector<Scheme>* list : {&schemes(), &explicit_schemes()})
    for (const Scheme& scheme : *list)
      if (scheme.name == name) return {&scheme};
  return {};
}

std::optional<Scheme> find_scheme(std::string_view name) {
  const std::vector<const Scheme*> found = meanings(name);
  return found.empty() ? std::nullopt : std::optional(*found.front());
}

Scheme statics_of(Scheme scheme) {
  scheme.is_static = true;
  scheme.tableau = nullptr;
  scheme.stress = StressRule::EndPoint;
  return scheme;
}

Scheme with_local_strains(Scheme scheme) {
  scheme.interpolation = Interpolation::Local;
  scheme.cayley_interpolation = false;
  scheme.weak_form = WeakForm::Spin;
  return scheme;
}

void take_constants_of_step(Scheme& scheme, const IntegratorDescription& integrator, double step) {
  scheme.blur = step;
  if (scheme.damping_relaxation > 0) scheme.damping_relaxation = step;
  if (scheme.dissipation.any())
    scheme.dissipation = numerical_dissipation(scheme.order, integrator.rho_infinity.value_or(kDefaultRho), step);
}

Scheme make_scheme(const IntegratorDescription& integrator) {
  const std::vector<const Scheme*> found = meanings(integrator.scheme);
  if (found.empty())
    throw ModelError(fmt::format("unknown integration scheme '{}', expected one of: {}", integrator.scheme,
                                 fmt::join(scheme_names(), " ")));
  for (const OptionConflict& conflict : option_conflicts(integrator))
    throw ModelError(fmt::format("<integrator>: {}: {}", conflict.attribute, conflict.message));
  Scheme scheme = integrator.rho_infinity.value_or(1) < 1 ? *found.back() : *found.front();
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw ModelError(fmt::format("<integrator>: {}", what));
  };
  if (integrator.beta) scheme.beta = *integrator.beta;
  if (integrator.gamma) scheme.gamma = *integrator.gamma;
  require(scheme.beta > 0 && scheme.gamma > 0, "beta and gamma must be > 0");
  if (integrator.gamma && scheme.gamma != 0.5) scheme.order = 1;
  if (integrator.alpha) scheme.set_alpha(*integrator.alpha);
  require(scheme.alpha >= -1.0 / 3 && scheme.alpha <= 0, "alpha must be from -1/3 to 0");
  if (integrator.interpolation) scheme.interpolation = *integrator.interpolation;
  if (integrator.weak_form) scheme.weak_form = *integrator.weak_form;
  const double rho = integrator.rho_infinity.value_or(kDefaultRho);
  require(rho >= 0 && rho <= 1, "rho_infinity must be from 0 to 1");
  const bool may_dissipate = scheme.dissipation.any();
  take_constants_of_step(scheme, integrator, integrator.step);
  if (may_dissipate) scheme.conserves_energy = !scheme.dissipation.any();
  scheme.may_be_planar = integrator.may_be_planar;
  return scheme;
}

}  // namespace flexarm
