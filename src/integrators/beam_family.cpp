#include "integrators/beam_family.h"

#include "integrators/conserving_beams.h"
#include "integrators/endpoint_beams.h"
#include "integrators/momentum_beams.h"

namespace flexarm {

const std::vector<Vector3>& BeamFamily::total_rotations() const {
  static const std::vector<Vector3> none;
  return none;
}

std::unique_ptr<BeamFamily> make_beam_family(const StepConfiguration& configuration, const StepPrestrains& prestrains) {
  switch (configuration.scheme().stress) {
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
