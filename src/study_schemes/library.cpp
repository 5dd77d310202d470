// What the core finds in this library, see integrators/study_library.h.
#include "integrators/study_library.h"
#include "study_schemes/initial_accelerations.h"
#include "study_schemes/momentum_beams.h"
#include "study_schemes/newmark_beams.h"

namespace flexarm {
namespace {

std::unique_ptr<SchemeFamily> make_family(const StepConfiguration& configuration, const StepPrestrains& prestrains) {
  if (configuration.scheme().stress == StressRule::EndPoint)
    return std::make_unique<NewmarkBeams>(configuration, prestrains);
  return std::make_unique<MomentumBeams>(configuration, prestrains);
}

std::unique_ptr<AccelerationFinder> make_acceleration_finder(const Model& model, const StepSettings& settings) {
  return std::make_unique<InitialAccelerations>(model, settings);
}

}  // namespace
}  // namespace flexarm

extern "C" const flexarm::StudyLibrary flexarm_study_schemes_library;
const flexarm::StudyLibrary flexarm_study_schemes_library = {flexarm::make_family, flexarm::make_acceleration_finder};
