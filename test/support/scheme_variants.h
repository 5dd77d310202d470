#pragma once
/// All schemes with all their options, for tests that must hold for each of them.

#include <ostream>
#include <string>
#include <vector>

#include "flexarm/schemes/integrator_description.h"
#include "schemes/scheme.h"

namespace flexarm::test {

struct SchemeVariant {
  std::string name;
  IntegratorDescription integrator;
  Scheme scheme;
  friend std::ostream& operator<<(std::ostream& out, const SchemeVariant& variant) { return out << variant.name; }
};

/// Returns every scheme of the table with default options, and with each interpolation and weak form that it accepts.
/// `step`: step size for numerical dissipation [s].
inline std::vector<SchemeVariant> scheme_variants(double step = 0.01) {
  std::vector<SchemeVariant> variants;
  const auto add = [&](const std::string& name, const IntegratorDescription& integrator) {
    if (option_conflicts(integrator).empty()) variants.push_back({name, integrator, make_scheme(integrator)});
  };
  for (const Scheme& scheme : schemes()) {
    IntegratorDescription integrator;
    integrator.scheme = scheme.name;
    integrator.step = step;
    add(integrator.scheme, integrator);
    for (const auto& [suffix, interpolation] : {std::pair{"_total", Interpolation::Total},
                                                {"_incremental", Interpolation::Incremental},
                                                {"_iterative", Interpolation::Iterative}}) {
      integrator.interpolation = interpolation;
      add(integrator.scheme + suffix, integrator);
    }
    integrator.interpolation = Interpolation::Total;
    integrator.weak_form = WeakForm::Additive;
    add(integrator.scheme + "_additive", integrator);
  }
  return variants;
}

/// Returns the variants whose scheme satisfies the predicate.
template <class Predicate>
std::vector<SchemeVariant> scheme_variants_where(const Predicate& suits) {
  std::vector<SchemeVariant> variants;
  for (const SchemeVariant& variant : scheme_variants())
    if (suits(variant.scheme)) variants.push_back(variant);
  return variants;
}

}  // namespace flexarm::test
