#include "bench/variants.h"

#include "flexarm/schemes/integrator_description.h"

namespace flexarm::bench {
namespace {

bool is_possible(const IntegratorDescription& integrator) {
  return option_conflicts(integrator).empty();
}

Variant variant(const IntegratorDescription& integrator) {
  return {integrator, make_scheme(integrator)};
}

IntegratorDescription default_integrator(const Scheme& scheme) {
  IntegratorDescription integrator;
  integrator.scheme = scheme.name;
  return integrator;
}

}  // namespace

const char* to_string(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::Local:
      return "local";
    case Interpolation::Total:
      return "total";
    case Interpolation::Incremental:
      return "incremental";
    case Interpolation::Iterative:
      return "iterative";
  }
  return "unknown";
}

std::string Variant::name() const {
  std::string name = integrator.scheme;
  if (integrator.interpolation) name += std::string(", ") + to_string(*integrator.interpolation);
  if (integrator.weak_form == WeakForm::Additive) name += ", additive";
  return name;
}

std::vector<Variant> variants() {
  std::vector<Variant> out;
  for (const Scheme& scheme : schemes()) {
    IntegratorDescription integrator = default_integrator(scheme);
    out.push_back(variant(integrator));
    for (const Interpolation interpolation :
         {Interpolation::Total, Interpolation::Incremental, Interpolation::Iterative}) {
      integrator.interpolation = interpolation;
      if (is_possible(integrator)) out.push_back(variant(integrator));
    }
    if (scheme.name != "newmark") continue;
    integrator.interpolation = Interpolation::Total;
    integrator.weak_form = WeakForm::Additive;
    out.push_back(variant(integrator));
  }
  return out;
}

std::vector<Variant> default_variants() {
  std::vector<Variant> out;
  for (const Scheme& scheme : schemes()) out.push_back(variant(default_integrator(scheme)));
  return out;
}

}  // namespace flexarm::bench
