#include "integrators/scheme_family.h"

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "integrators/conserving_beams.h"
#include "integrators/nodal_forces.h"
#include "integrators/static_beams.h"
#include "integrators/study_library.h"

namespace flexarm {

SchemeFamily::~SchemeFamily() = default;

void SchemeFamily::add_loads(const NodalForces& loads, Balance& balance) {
  loads.evaluate(balance);
}

std::unique_ptr<SchemeFamily> make_scheme_family(const StepConfiguration& configuration,
                                                 const StepPrestrains& prestrains) {
  const Scheme& scheme = configuration.scheme();
  // In the backward steps of compositions, errors of what has relaxed would grow with exp(h / relaxation time).
  const bool takes_maxwell = scheme.is_static || (!scheme.is_for_study() && !scheme.is_composition);
  if (configuration.model().maxwell_branches > 0 && !takes_maxwell)
    throw ModelError(fmt::format(
        "<integrator>: scheme '{}' has no <maxwell> elements of beams; take em, em0, em_symmetric, edmc1 or "
        "edmc2",
        scheme.name));
  if (scheme.is_for_study()) return study_library(scheme).make_family(configuration, prestrains);
  if (scheme.is_static) return std::make_unique<StaticBeams>(configuration, prestrains);
  return std::make_unique<ConservingBeams>(configuration, prestrains);
}

}  // namespace flexarm
