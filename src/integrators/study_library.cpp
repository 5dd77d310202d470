#include "integrators/study_library.h"

#include <fmt/format.h>

#include "flexarm/model/model_error.h"
#include "math/loaded_library.h"

namespace flexarm {

const StudyLibrary& study_library(const Scheme& scheme) {
  constexpr const char* kLibrary = "libflexarm_study_schemes.so";
  try {
    static const StudyLibrary& library = loaded_functions<StudyLibrary>(kLibrary, kStudySymbol, "it cannot be loaded");
    return library;
  } catch (const std::runtime_error& error) {
    throw ModelError(
        fmt::format("<integrator>: scheme '{}' with these options is for study, and in the library {}: {}. "
                    "scripts/build builds it (target flexarm_study_schemes); em, em0, em_symmetric, em4, "
                    "edmc1 and edmc2 do without",
                    scheme.name, kLibrary, error.what()));
  }
}

}  // namespace flexarm
