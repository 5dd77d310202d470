#include "flexarm/schemes/integrator_description.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "schemes/scheme.h"

namespace flexarm {
namespace {

using Option = bool SchemeOptions::*;

bool takes(std::string_view name, Option option) {
  const std::vector<const Scheme*> found = meanings(name);
  return std::any_of(found.begin(), found.end(), [&](const Scheme* scheme) { return scheme->options.*option; });
}

/// Names of all schemes with this option: "auto, edmc1, edmc2".
std::string owners(Option option) {
  std::vector<std::string_view> names = scheme_names();
  names.erase(std::remove_if(names.begin(), names.end(), [&](std::string_view name) { return !takes(name, option); }),
              names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether the scheme has a fixed interpolation of its own, which a scene cannot change.
bool has_own_interpolation(std::string_view name) {
  const std::vector<const Scheme*> found = meanings(name);
  return !found.empty() && found.front()->interpolation != Interpolation::Local;
}

}  // namespace

std::optional<OnFailure> on_failure_called(std::string_view name) {
  if (name == "stop") return OnFailure::Stop;
  if (name == "dissipate") return OnFailure::Dissipate;
  return std::nullopt;
}

const std::vector<std::string_view>& scheme_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> out = {"auto"};
    for (const std::vector<Scheme>* list : {&schemes(), &explicit_schemes()})
      for (const Scheme& scheme : *list) out.push_back(scheme.name);
    return out;
  }();
  return names;
}

std::vector<OptionConflict> option_conflicts(const IntegratorDescription& integrator) {
  std::vector<OptionConflict> conflicts;
  const std::string& scheme = integrator.scheme;
  const auto require = [&](bool ok, const char* attribute, const std::string& message) {
    if (!ok) conflicts.push_back({attribute, message});
  };
  const auto require_owner = [&](bool is_set, Option option, const char* attribute) {
    require(!is_set || takes(scheme, option), attribute,
            "scheme '" + scheme + "' does not have this option; it belongs to " + owners(option));
  };
  require_owner(integrator.beta.has_value(), &SchemeOptions::beta, "beta");
  require_owner(integrator.gamma.has_value(), &SchemeOptions::gamma, "gamma");
  require_owner(integrator.alpha.has_value(), &SchemeOptions::alpha, "alpha");
  require_owner(integrator.rho_infinity.has_value(), &SchemeOptions::rho_infinity, "rho_infinity");
  const Interpolation interpolation = integrator.interpolation.value_or(Interpolation::Local);
  const bool takes_any = takes(scheme, &SchemeOptions::interpolation);
  if (integrator.interpolation && has_own_interpolation(scheme))
    require(false, "interpolation",
            "scheme '" + scheme + "' interpolates its own, tangent-scaled increments; leave this out");
  else
    require(interpolation == Interpolation::Local || takes_any, "interpolation",
            "scheme '" + scheme + "' is built on the local interpolation");
  require(interpolation != Interpolation::Iterative || !takes_any || takes(scheme, &SchemeOptions::iterative),
          "interpolation",
          "scheme '" + scheme +
              "' evaluates two configurations for each iterate; the iterative interpolation follows only one");
  const bool is_additive = integrator.weak_form == WeakForm::Additive;
  require(!is_additive || takes(scheme, &SchemeOptions::additive), "weak_form",
          "the additive form does not conserve momenta; it belongs to " + owners(&SchemeOptions::additive));
  const bool has_substitute = takes(scheme, &SchemeOptions::substitute) &&
                              integrator.rho_infinity.value_or(1) >= 1;  // "auto" with rho < 1: edmc2
  require(integrator.on_failure == OnFailure::Stop || has_substitute, "on_failure",
          "edmc2 cannot continue from states of scheme '" + scheme +
              "', or is the scheme itself; 'dissipate' belongs to " + owners(&SchemeOptions::substitute));
  require(!is_additive || interpolation == Interpolation::Total, "weak_form",
          "the additive form needs interpolation=\"total\"");
  return conflicts;
}

IntegratorDescription with_scheme(IntegratorDescription integrator, const std::string& scheme) {
  integrator.scheme = scheme;
  for (const OptionConflict& conflict : option_conflicts(integrator)) {
    if (conflict.attribute == "beta") integrator.beta.reset();
    if (conflict.attribute == "gamma") integrator.gamma.reset();
    if (conflict.attribute == "alpha") integrator.alpha.reset();
    if (conflict.attribute == "rho_infinity") integrator.rho_infinity.reset();
    if (conflict.attribute == "interpolation") integrator.interpolation.reset();
    if (conflict.attribute == "weak_form") integrator.weak_form.reset();
    if (conflict.attribute == "on_failure") integrator.on_failure = OnFailure::Stop;
  }
  return integrator;
}

}  // namespace flexarm
