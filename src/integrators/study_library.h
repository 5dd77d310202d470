#pragma once
/// The interface of the library of the room study_schemes/. It has the schemes that exist to reproduce and compare
/// published results, and is loaded when the first of them is named.

#include <memory>

#include "integrators/acceleration_finder.h"
#include "integrators/scheme_family.h"
#include "integrators/step_settings.h"

namespace flexarm {

/// The functions of the library.
struct StudyLibrary {
  /// Creates the family of the configuration's scheme.
  std::unique_ptr<SchemeFamily> (*make_family)(const StepConfiguration& configuration,
                                               const StepPrestrains& prestrains);
  /// Creates what finds the accelerations from which Newmark's family starts. `settings`: of the steps to come.
  std::unique_ptr<AccelerationFinder> (*make_acceleration_finder)(const Model& model, const StepSettings& settings);
};

/// The name of the library's only symbol: a `const StudyLibrary`.
constexpr const char* kStudySymbol = "flexarm_study_schemes_library";

/// The library, loaded when this is called for the first time.
/// @throws ModelError saying that `scheme` needs it, if it cannot be loaded
const StudyLibrary& study_library(const Scheme& scheme);

}  // namespace flexarm
