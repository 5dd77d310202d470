#include "scene/integrator_options.h"

#include <algorithm>

namespace flexarm::scene {
namespace {

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Schemes whose kernels take any interpolation; the energy-momentum ones are built on the local one.
bool is_for_all_interpolations(std::string_view scheme) {
  return is_newmark_family(scheme) ||
         is_one_of(scheme, {"m1", "m2", "beta1", "beta2", "beta1_repaired", "beta2_repaired"});
}

}  // namespace

bool is_newmark_family(std::string_view scheme) {
  return is_one_of(scheme, {"newmark", "hht1", "hht2", "hht3"});
}

const std::vector<std::string_view>& scheme_names() {
  static const std::vector<std::string_view> names = {
      "auto", "em",    "em0",   "em_scaled",      "em_symmetric",   "em4",     "edmc1", "edmc2", "m1",  "m2",
      "std",  "beta1", "beta2", "beta1_repaired", "beta2_repaired", "newmark", "hht1",  "hht2",  "hht3"};
  return names;
}

std::vector<OptionConflict> option_conflicts(const IntegratorDescription& integrator) {
  std::vector<OptionConflict> conflicts;
  const std::string& scheme = integrator.scheme;
  const auto require = [&](bool ok, const char* attribute, const std::string& message) {
    if (!ok) conflicts.push_back({attribute, message});
  };
  const std::string has_not = "scheme '" + scheme + "' does not have this option; it belongs to ";
  require(!integrator.beta || scheme == "newmark", "beta", has_not + "newmark");
  require(!integrator.gamma || scheme == "newmark", "gamma", has_not + "newmark");
  require(!integrator.alpha || is_one_of(scheme, {"hht1", "hht2", "hht3"}), "alpha", has_not + "hht1, hht2, hht3");
  require(!integrator.rho_infinity || is_one_of(scheme, {"auto", "edmc1", "edmc2"}), "rho_infinity",
          has_not + "auto, edmc1, edmc2");
  const Interpolation interpolation = integrator.interpolation.value_or(Interpolation::Local);
  if (integrator.interpolation && scheme == "std")
    require(false, "interpolation", "scheme 'std' interpolates its own, tangent-scaled increments; leave this out");
  else
    require(interpolation == Interpolation::Local || is_for_all_interpolations(scheme), "interpolation",
            "scheme '" + scheme + "' is built on the local interpolation");
  require(interpolation != Interpolation::Iterative || scheme != "hht3", "interpolation",
          "scheme 'hht3' evaluates two configurations for each iterate; the iterative interpolation follows only one");
  const bool is_additive = integrator.weak_form == WeakForm::Additive;
  require(!is_additive || is_newmark_family(scheme), "weak_form",
          "the additive form does not conserve momenta; it belongs to newmark, hht1, hht2, hht3");
  require(!is_additive || interpolation == Interpolation::Total, "weak_form",
          "the additive form needs interpolation=\"total\"");
  return conflicts;
}

std::string slide_scheme_conflict(const std::string& slide, const std::string& scheme) {
  if (slide == "sm_em" || is_newmark_family(scheme)) return "";
  const std::string owner = slide == "sme" ? "std" : slide == "alg2" ? "m2" : "m1";
  if (scheme == owner) return "";
  return "slide scheme '" + slide + "' belongs to integrator scheme '" + owner + "', not to '" + scheme + "'";
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
  }
  return integrator;
}

}  // namespace flexarm::scene
