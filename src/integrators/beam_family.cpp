#include "integrators/beam_family.h"

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "integrators/conserving_beams.h"
#include "integrators/endpoint_beams.h"
#include "integrators/momentum_beams.h"

namespace flexarm {

const std::vector<Vector3>& BeamFamily::total_rotations() const {
  static const std::vector<Vector3> none;
  return none;
}

std::unique_ptr<BeamFamily> make_beam_family(const StepConfiguration& configuration, const StepPrestrains& prestrains) {
  const Scheme& scheme = configuration.scheme();
  // In the backward steps of compositions, errors of what has relaxed would grow with exp(h / relaxation time).
  const bool takes_maxwell = scheme.is_static || (scheme.stress == StressRule::Conjugate && !scheme.is_composition);
  if (configuration.model().maxwell_branches > 0 && !takes_maxwell)
    throw ModelError(fmt::format(
        "<integrator>: scheme '{}' has no <maxwell> elements of beams; take em, em0, em_symmetric, edmc1 or "
        "edmc2",
        scheme.name));
  switch (scheme.stress) {
    case StressRule::Conjugate:
      return std::make_unique<ConservingBeams>(configuration, prestrains);
    case StressRule::EndPoint:
      return std::make_unique<EndpointBeams>(configuration, prestrains);
    case StressRule::ExponentialMoment:
    case StressRule::CayleyMoment:
      return std::make_unique<MomentumBeams>(configuration, prestrains);
  }
  return nullptr;
}

}  // namespace flexarm
